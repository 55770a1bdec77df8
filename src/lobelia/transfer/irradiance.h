// What diffuse surfaces receive where nothing is in the way. Eight lobes for the octants of the
// sphere tell well how what is in the way shadows a diffuse surface, but not what it receives: two
// lobes that lie side by side leave a seam, and all of them leak below the horizon, which together
// is much of the light of a hall with bright windows. So octants give a ratio alone.
#pragma once

#include "lobelia/transfer/prefiltered_light.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::transfer {

// Light convolved with a clamped cosine.
class Irradiance {
 public:
  explicit Irradiance(const PrefilteredLight& light);
  // Over pi: what a white surface sends on. n: unit, in the frame of the light. Linear between 642
  // normals.
  Rgb at(Vec3f n) const;

 private:
  GeodesicGrid normals_;
  std::vector<Rgb> values_;
};

// The lobes of octants of unoccluded vertices, as TransferPass::diffuse has them of others.
std::vector<DiffuseLobes> unoccludedDiffuse(std::span<const TransferVertex> vertices,
                                            const DiffuseSides& sides);

}  // namespace lobelia::transfer
