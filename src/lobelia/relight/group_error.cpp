// Left out: scalable vectors and SSSE3, as in gather/kernels.cpp.
#include "lobelia/relight/group_error.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/relight/group_error.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/relight/group_error-inl.h"

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(largestError);
}  // namespace lobelia

namespace lobelia::relight {

GroupLanes::GroupLanes(std::span<const PixelGroup> groups) {
  for (size_t i = 0; i < kMost; ++i) {
    const PixelGroup& group = groups[i < groups.size() ? i : 0];
    const Vec3f c = group.box.centre(), h = group.box.extent() * 0.5f;
    for (int k = 0; k < 3; ++k) {
      centre[k][i] = c[k], half[k][i] = h[k];
      normal[k][i] = group.normal[k], axis[k][i] = group.axis[k];
    }
    bend[i] = group.bend, chord[i] = group.chord, width[i] = group.width, peak[i] = group.peak;
    size[i] = length(h);
  }
}

float largestError(const GroupLanes& groups, const NodeShape& node, float softening) {
  return HWY_DYNAMIC_DISPATCH(lobelia::largestError)(groups, node, softening);
}

}  // namespace lobelia::relight
#endif
