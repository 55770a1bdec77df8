#include "lobelia/transfer/pixel_packet.h"

namespace lobelia::transfer {

LobeRow::LobeRow(const TransferLobe& lobe, Vec3f mirror)
    : share(lobe.share),
      energy(luminance(lobe.share)),
      moment(lobe.r * energy),
      lengths(length(lobe.r) * energy),
      mirrors(mirror * energy) {}

VisibleRow::VisibleRow(const VisiblePart& part) {
  if (part.whole) return;
  share = part.share, energy = luminance(part.share);
  own = part.own, axis = part.axis * energy, width = part.width * energy;
  whole = 0;
}

void PixelPacket::fillUp() {
  const auto fill = [&](Lanes& lanes) {
    for (size_t i = count; i < kSize; ++i) lanes.at[i] = lanes.at[0];
  };
  const auto fillVectors = [&](Vectors& v) { fill(v.x), fill(v.y), fill(v.z); };
  for (Vectors* v : {&n, &wo, &emitted, &diffuse, &glossy, &mirror, &r}) fillVectors(*v);
  for (int j = 0; j < lobeCount; ++j) {
    fillVectors(lobes[j].axis), fillVectors(lobes[j].alpha), fill(lobes[j].kappa);
  }
  for (size_t v = 0; v < 3; ++v) {
    fill(weight[v]);
    for (size_t i = count; i < kSize; ++i) slot[v][i] = slot[v][0];
  }
}

}  // namespace lobelia::transfer
