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
#include "lobelia/gather/by_class-inl.h"
#include "lobelia/gather/gaussian-inl.h"
#include "lobelia/gather/rich_shading-inl.h"
#include "lobelia/gather/shading-inl.h"
#include "lobelia/gather/spherical-inl.h"
#include "lobelia/gather/visibility-inl.h"

LOBELIA_CORE_BEGIN

size_t keepVisible(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                   g::PairMasks* pairs, bool coherent) {
  return byClass(block.lightClass, [&](auto c) {
    return keepVisibleOf<decltype(c)::value>(tile, block, tracer, pairs, coherent);
  });
}

template <class Out>
void shadeClass(const g::Tile& tile, const g::LightBlock& block, float clamp,
                const g::PairMasks& pairs, Out* out) {
  byClass(block.lightClass,
          [&](auto c) { shadeOf<decltype(c)::value>(tile, block, clamp, pairs, out); });
}

void shade(const g::Tile& tile, const g::LightBlock& block, float clamp, const g::PairMasks& pairs,
           g::TileSums* sums) {
  shadeClass(tile, block, clamp, pairs, sums);
}

void shadePairs(const g::Tile& tile, const g::LightBlock& block, float clamp,
                const g::PairMasks& pairs, g::PairValues* values) {
  shadeClass(tile, block, clamp, pairs, values);
}

void shadeLuminances(const g::Tile& tile, const g::LightBlock& block, float clamp,
                     const g::PairMasks& pairs, g::PairLuminances* luminances) {
  shadeOf<g::LightClass::gaussian>(tile, block, clamp, pairs, luminances);
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(keepVisible);
HWY_EXPORT(shade);
HWY_EXPORT(shadePairs);
HWY_EXPORT(shadeLuminances);
}  // namespace lobelia

namespace lobelia::gather {

size_t keepVisible(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                   PairMasks* pairs, bool coherent) {
  return HWY_DYNAMIC_DISPATCH(lobelia::keepVisible)(tile, block, tracer, pairs, coherent);
}

void shade(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
           TileSums* sums) {
  HWY_DYNAMIC_DISPATCH(lobelia::shade)(tile, block, clamp, pairs, sums);
}

void shadePairs(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
                PairValues* values) {
  HWY_DYNAMIC_DISPATCH(lobelia::shadePairs)(tile, block, clamp, pairs, values);
}

void shadeLuminances(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
                     PairLuminances* luminances) {
  HWY_DYNAMIC_DISPATCH(lobelia::shadeLuminances)(tile, block, clamp, pairs, luminances);
}

}  // namespace lobelia::gather
#endif
