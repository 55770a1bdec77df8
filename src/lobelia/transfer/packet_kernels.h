// Pixels shaded in registers, compiled for every SIMD target and chosen at run time.
#pragma once

#include "lobelia/transfer/pixel_packet.h"

namespace lobelia::transfer {

// Sets the packet's reflection from a material's table, by its n and wo.
void lookUpReflection(const ElevationRows& table, PixelPacket* packet);
// Sets its radiance, for the lanes in use: what it emits and reflects. Returns how often light was
// looked up for them.
size_t shadePacket(const VertexRows& vertices, const PacketLight& light, PixelPacket* packet);

void lookUpLight(const PacketLight& light, LobePacket* packet);

}  // namespace lobelia::transfer
