// Left out: scalable vectors and SSSE3, as in gather/kernels.cpp.
#include "lobelia/relight/pixel_kernels.h"

#include <bit>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/relight/pixel_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/relight/pixel_shading-inl.h"

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(findLit);
HWY_EXPORT(appendLight);
HWY_EXPORT(sumLobe);
HWY_EXPORT(findUnits);
}  // namespace lobelia

namespace lobelia::relight {

void DirectedLight::reserve(size_t chunks) {
  if (chunk.size() >= chunks) return;
  for (AlignedFloats* values : {&x, &y, &z, &r, &g, &b}) values->resize(chunks * kChunk, 0.f);
  chunk.resize(chunks);
  lit.resize(chunks);
}

void findLit(const LightRows& rows, size_t chunkCount, uint16_t* lit) {
  HWY_DYNAMIC_DISPATCH(lobelia::findLit)(rows, chunkCount, lit);
}

void appendLight(const VertexLights& lights, size_t chunkCount, Vec3f normal, DirectedLight* out) {
  HWY_DYNAMIC_DISPATCH(lobelia::appendLight)(lights, chunkCount, normal, out);
}

Rgb sumLobe(const LobeQuery& query, const DirectedLight& light, const uint16_t* masks,
            uint64_t* evaluations) {
  return HWY_DYNAMIC_DISPATCH(lobelia::sumLobe)(query, light, masks, evaluations);
}

void findUnits(const FineUnits& units, Vec3f axis, float radius, std::vector<uint32_t>* found) {
  HWY_DYNAMIC_DISPATCH(lobelia::findUnits)(units, axis, radius, found);
}

}  // namespace lobelia::relight
#endif
