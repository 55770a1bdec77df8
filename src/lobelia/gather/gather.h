// Gather strategies: light of virtual lights at receivers.
#pragma once

#include <span>

#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/receivers.h"

namespace lobelia {

struct GatherSettings {
  float clamp = 0;  // upper limit of geometry term x light lobe x receiver lobe; 0: off
  int maxDepth = -1;
  bool direct = false;  // lights of depth 0 (--direct lights) are part of the lights
};

// Adds to radiance[i] the light that receiver point i sends to its pixel (weight included) from all
// lights. Counts "shadow_rays", "node_pairs_shaded" and "nonfinite"; books seconds to "visibility"
// and "shade".
void gatherAll(const Tracer& tracer, const Receivers& receivers, const VirtualLights& lights,
               const GatherSettings& settings, std::span<Rgb> radiance, Context& context);

}  // namespace lobelia
