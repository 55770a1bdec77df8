// Light that receivers find by rays of their own: --compensate and --lights photon.
#pragma once

#include "lobelia/app/band_plan.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/lights/photon_map.h"

namespace lobelia::app {

// Throws UsageError where options of these methods stand with others that know nothing of them.
void requireOwnLight(const RenderOptions& options);

// Photons of a set; null for other light models.
std::unique_ptr<PhotonMap> obtainPhotons(const Tracer& tracer, const EmitterSampler& emitters,
                                         int maxDepth, int set, const RenderOptions& options,
                                         Context& context);

struct OwnLightInput {
  const Tracer& tracer;
  const EmitterSampler& emitters;
  const PhotonMap* photons;  // null: other light models
  const BandPlan& plan;
  int maxDepth;
  const RenderOptions& options;
};

// Adds to the film's layer "indirect" (and, where given, to those that take light apart), for all
// receivers or, when cancelled, for none. Returns what was added, by receiver point; empty: nothing
// was wanted.
std::vector<Rgb> addOwnLight(const OwnLightInput& in, const Receivers& receivers, Film& film,
                             LightLayers* layers, Context& context);

}  // namespace lobelia::app
