// Path-traced compensation of what virtual lights leave out [Kollig04].
#pragma once

#include "lobelia/gather/receiver_rays.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia {

// What the gather and its lights were made with.
struct CompensationSettings {
  ReceiverRaySettings rays;
  float clamp = 0;     // GatherSettings::clamp
  bool glossy = true;  // LightSettings, from here on
  int maxDepth = -1;
  float specularLimit = 0.08f;
  int gaussiansPerLobe = LightSettings().gaussiansPerLobe;
};

// Adds to radiance[i] one sample of the light that receiver point i would get from rough surfaces,
// less what gatherAll() adds in expectation over lights of makeLights() that lie on bounces: by the
// clamp, by lobes that the lights lack, by the difference between lobes and their Gaussians. May be
// negative. Counts, seconds ("compensate") and parts: lightReceivers().
void compensate(const Tracer& tracer, const EmitterSampler& emitters, const Receivers& receivers,
                const CompensationSettings& settings, std::span<Rgb> radiance, Context& context,
                GatherParts* parts = nullptr);

}  // namespace lobelia
