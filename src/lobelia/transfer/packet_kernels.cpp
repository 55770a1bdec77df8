// Registers run over pixels; left out: scalable vectors and SSSE3, as in gather/kernels.cpp.
#include "lobelia/transfer/packet_kernels.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/transfer/packet_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/transfer/packet_shading-inl.h"

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(lookUpReflection);
HWY_EXPORT(shadePacket);
HWY_EXPORT(lookUpLight);
}  // namespace lobelia

namespace lobelia::transfer {

void lookUpReflection(const ElevationRows& table, PixelPacket* packet) {
  HWY_DYNAMIC_DISPATCH(lobelia::lookUpReflection)(table, packet);
}

size_t shadePacket(const VertexRows& vertices, const PacketLight& light, PixelPacket* packet) {
  return HWY_DYNAMIC_DISPATCH(lobelia::shadePacket)(vertices, light, packet);
}

void lookUpLight(const PacketLight& light, LobePacket* packet) {
  HWY_DYNAMIC_DISPATCH(lobelia::lookUpLight)(light, packet);
}

}  // namespace lobelia::transfer
#endif
