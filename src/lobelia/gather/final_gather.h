// Photon mapping with final gathering [Jensen01].
#pragma once

#include "lobelia/gather/receiver_rays.h"
#include "lobelia/lights/photon_map.h"

namespace lobelia {

struct FinalGatherSettings {
  ReceiverRaySettings rays;
  int rayCount = 4;     // per receiver point and eye sample
  size_t nearest = 50;  // photons of an estimate
  float maxRadius = 0;  // ... at most so far away; > 0
  int maxDepth = -1;    // as LightSettings
  float specularLimit = 0.08f;
};

// Adds to radiance[i] the light that receiver point i gets from rough surfaces, as photons tell it.
// Counts, seconds ("final_gather") and parts: lightReceivers().
void finalGather(const Tracer& tracer, const Receivers& receivers, const PhotonMap& photons,
                 const FinalGatherSettings& settings, std::span<Rgb> radiance, Context& context,
                 GatherParts* parts = nullptr);

}  // namespace lobelia
