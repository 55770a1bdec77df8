// Left out: scalable vectors and SSSE3, as in gather/kernels.cpp.
#include "lobelia/relight/local_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/relight/local_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/relight/local_shading-inl.h"

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(gatherNearLight);
HWY_EXPORT(sumWidenedLobe);
}  // namespace lobelia

namespace lobelia::relight {

void gatherNearLight(const NearLights& lights, std::span<const uint32_t> chunks, Vec3f p,
                     Vec3f normal, NearLight* out) {
  HWY_DYNAMIC_DISPATCH(lobelia::gatherNearLight)(lights, chunks, p, normal, out);
}

Rgb sumWidenedLobe(const LobeQuery& query, const NearLight& light, float reach,
                   uint64_t* evaluations) {
  return HWY_DYNAMIC_DISPATCH(lobelia::sumWidenedLobe)(query, light, reach, evaluations);
}

}  // namespace lobelia::relight
#endif
