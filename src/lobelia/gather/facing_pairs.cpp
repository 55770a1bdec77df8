#include "lobelia/gather/facing_pairs.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/facing_pairs.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/by_class-inl.h"
#include "lobelia/gather/facing-inl.h"

LOBELIA_CORE_BEGIN

template <g::LightClass kClass>
uint32_t facingLanes(const g::PointStrip& strip, const g::PreparedLight& light, size_t lane) {
  const V3<Vf> d = toLight<kClass>(light, load(strip.p, lane));
  return maskBits(lightFaces<kClass>(light, d) & receiverFaces(strip, lane, d, light.extent) &
                  beyondNear<kClass>(strip, lane, d));
}

template <g::LightClass kClass>
void keepFacingOf(const g::Tile& tile, const g::LightBlock& block, g::PairMasks* pairs) {
  for (size_t l = 0; l < static_cast<size_t>(block.count); ++l) {
    for (size_t s = 0; s < tile.strips.size(); ++s) {
      const uint32_t candidates = pairs->at(l, s);
      if (candidates == 0) continue;
      uint32_t facing = 0;
      for (size_t lane = 0; lane < g::kStrip; lane += kLanes)
        if ((candidates >> lane & ((1u << kLanes) - 1)) != 0)
          facing |= facingLanes<kClass>(tile.strips[s], block.lights[l], lane) << lane;
      pairs->at(l, s) = static_cast<uint16_t>(candidates & facing);
    }
  }
}

template <g::LightClass kClass>
bool facesOf(const g::Tile& tile, size_t s, size_t lane, const g::PreparedLight& light) {
  const size_t first = lane / kLanes * kLanes;
  return facingLanes<kClass>(tile.strips[s], light, first) >> (lane - first) & 1;
}

void keepFacing(const g::Tile& tile, const g::LightBlock& block, g::PairMasks* pairs) {
  byClass(block.lightClass, [&](auto c) { keepFacingOf<decltype(c)::value>(tile, block, pairs); });
}

bool faces(const g::Tile& tile, size_t strip, size_t lane, const g::LightBlock& block,
           size_t light) {
  return byClass(block.lightClass, [&](auto c) {
    return facesOf<decltype(c)::value>(tile, strip, lane, block.lights[light]);
  });
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(keepFacing);
HWY_EXPORT(faces);
}  // namespace lobelia

namespace lobelia::gather {

void keepFacing(const Tile& tile, const LightBlock& block, PairMasks* pairs) {
  HWY_DYNAMIC_DISPATCH(lobelia::keepFacing)(tile, block, pairs);
}

bool faces(const Tile& tile, size_t strip, size_t lane, const LightBlock& block, size_t light) {
  return HWY_DYNAMIC_DISPATCH(lobelia::faces)(tile, strip, lane, block, light);
}

}  // namespace lobelia::gather
#endif
