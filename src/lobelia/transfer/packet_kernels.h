// Pixels shaded in registers, compiled for every SIMD target and chosen at run time.
#pragma once

#include "lobelia/transfer/pixel_packet.h"

namespace lobelia::transfer {

// Sets the packet's reflection from a material's table, by its n and wo.
void lookUpReflection(const ElevationRows& table, PixelPacket* packet);
// Sets its radiance: what it emits and reflects. Returns how often light was looked up, for each
// lane.
size_t shadePacket(const VertexRows& vertices, const PacketLight& light, PixelPacket* packet);

}  // namespace lobelia::transfer
