// Left out: scalable vectors and SSSE3, as in gather/kernels.cpp.
#include "lobelia/transfer/lobe_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/transfer/lobe_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/transfer/lobe_kernels-inl.h"

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(addWeights);
HWY_EXPORT(findMeeting);
}  // namespace lobelia

namespace lobelia::transfer {

void addWeights(const LobeLanes& query, std::span<const uint32_t> chunks, bool first, float* out) {
  HWY_DYNAMIC_DISPATCH(lobelia::addWeights)(query, chunks, first, out);
}

void findMeeting(const ChunkCones& cones, std::span<const LobeCone> lobes,
                 std::vector<uint32_t>* chunks) {
  HWY_DYNAMIC_DISPATCH(lobelia::findMeeting)(cones, lobes, chunks);
}

}  // namespace lobelia::transfer
#endif
