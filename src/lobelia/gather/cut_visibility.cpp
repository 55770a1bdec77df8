// One shadow ray for all points of a strip (cut_kernels.h).
#include "lobelia/base/random.h"
#include "lobelia/gather/cut_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/cut_visibility.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/visibility-inl.h"

LOBELIA_CORE_BEGIN

template <g::LightClass kClass>
uint32_t facingPoints(const g::Tile& tile, const g::PreparedLight& light) {
  uint32_t bits = 0;
  const g::PointStrip& strip = tile.strips[0];
  for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
    const V3<Vf> d = toLight<kClass>(light, load(strip.p, lane));
    bits |= maskBits(lightFaces<kClass>(light, d) & receiverFaces(strip, lane, d)) << lane;
  }
  return bits;
}

template <g::LightClass kClass>
size_t keepVisibleByOneOf(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                          uint64_t seed, g::PairMasks* pairs) {
  uint16_t facing[g::kBlockLights];
  for (size_t l = 0; l < static_cast<size_t>(block.count); ++l) {
    const uint32_t bits = pairs->at(l, 0) & facingPoints<kClass>(tile, block.lights[l]);
    facing[l] = static_cast<uint16_t>(bits);
    pairs->at(l, 0) = 0;
    if (bits == 0) continue;
    const uint64_t random = hashCombine(seed, l) >> 32;
    uint32_t skip =
        static_cast<uint32_t>(random * static_cast<uint64_t>(__builtin_popcount(bits)) >> 32);
    uint32_t rest = bits;
    for (; skip > 0; --skip) rest &= rest - 1;
    pairs->at(l, 0) = static_cast<uint16_t>(rest & (~rest + 1));
  }
  const size_t rays = keepVisibleOf<kClass>(tile, block, tracer, pairs);
  for (size_t l = 0; l < static_cast<size_t>(block.count); ++l)
    if (pairs->at(l, 0) != 0) pairs->at(l, 0) = facing[l];
  return rays;
}

size_t keepVisibleByOne(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                        uint64_t seed, g::PairMasks* pairs) {
  switch (block.lightClass) {
    case g::LightClass::omni:
      return keepVisibleByOneOf<g::LightClass::omni>(tile, block, tracer, seed, pairs);
    case g::LightClass::directional:
      return keepVisibleByOneOf<g::LightClass::directional>(tile, block, tracer, seed, pairs);
    case g::LightClass::diffuse:
      return keepVisibleByOneOf<g::LightClass::diffuse>(tile, block, tracer, seed, pairs);
    case g::LightClass::spherical:
      return keepVisibleByOneOf<g::LightClass::spherical>(tile, block, tracer, seed, pairs);
    case g::LightClass::glossy:
      break;
  }
  return keepVisibleByOneOf<g::LightClass::glossy>(tile, block, tracer, seed, pairs);
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(keepVisibleByOne);
}  // namespace lobelia

namespace lobelia::gather {

size_t keepVisibleByOne(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                        uint64_t seed, PairMasks* pairs) {
  return HWY_DYNAMIC_DISPATCH(lobelia::keepVisibleByOne)(tile, block, tracer, seed, pairs);
}

}  // namespace lobelia::gather
#endif
