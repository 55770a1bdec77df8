// The kernels of a brute-force gather for every SIMD target; the best that the processor has is
// chosen at run time.
//
// Left out: scalable vectors (SVE, RVV), which Vf cannot hold (processors with SVE run NEON), and
// SSSE3, for which SSE4 or the baseline stand in.
#include "lobelia/gather/kernels.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/shading-inl.h"
#include "lobelia/gather/spherical-inl.h"
#include "lobelia/gather/visibility-inl.h"

LOBELIA_CORE_BEGIN

size_t keepVisible(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                   g::PairMasks* pairs) {
  switch (block.lightClass) {
    case g::LightClass::omni:
      return keepVisibleOf<g::LightClass::omni>(tile, block, tracer, pairs);
    case g::LightClass::directional:
      return keepVisibleOf<g::LightClass::directional>(tile, block, tracer, pairs);
    case g::LightClass::diffuse:
      return keepVisibleOf<g::LightClass::diffuse>(tile, block, tracer, pairs);
    case g::LightClass::spherical:
      return keepVisibleOf<g::LightClass::spherical>(tile, block, tracer, pairs);
    case g::LightClass::glossy:
      break;
  }
  return keepVisibleOf<g::LightClass::glossy>(tile, block, tracer, pairs);
}

void shade(const g::Tile& tile, const g::LightBlock& block, float clamp, const g::PairMasks& pairs,
           g::TileSums* sums) {
  switch (block.lightClass) {
    case g::LightClass::omni:
      return shadeOf<g::LightClass::omni>(tile, block, clamp, pairs, sums);
    case g::LightClass::directional:
      return shadeOf<g::LightClass::directional>(tile, block, clamp, pairs, sums);
    case g::LightClass::diffuse:
      return shadeOf<g::LightClass::diffuse>(tile, block, clamp, pairs, sums);
    case g::LightClass::glossy:
      return shadeOf<g::LightClass::glossy>(tile, block, clamp, pairs, sums);
    case g::LightClass::spherical:
      return shadeOf<g::LightClass::spherical>(tile, block, clamp, pairs, sums);
  }
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(keepVisible);
HWY_EXPORT(shade);
}  // namespace lobelia

namespace lobelia::gather {

size_t keepVisible(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                   PairMasks* pairs) {
  return HWY_DYNAMIC_DISPATCH(lobelia::keepVisible)(tile, block, tracer, pairs);
}

void shade(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
           TileSums* sums) {
  HWY_DYNAMIC_DISPATCH(lobelia::shade)(tile, block, clamp, pairs, sums);
}

}  // namespace lobelia::gather
#endif
