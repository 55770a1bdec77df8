// Virtual spherical Gaussian lights of a set: points of the light pass or of reflective shadow
// maps, clustered as --vsgl-clusters says.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/lights/reflective_shadow_map.h"

namespace lobelia::app {

// settings.count: lights aimed at; each kind has at least one. Points of different light groups,
// those on emitters and, where paths are limited, those of different depths are clustered apart.
// Books and counts as makeLights() does, "light_points" and seconds of "lights".
VirtualLights makeGaussianLights(const Tracer& tracer, const EmitterSampler& emitters,
                                 const LightSettings& settings, const RenderOptions& options,
                                 Context& context);

// The same of given maps, whatever clusters: to `lights`, which has no such lights.
void addClusters(const Tracer& tracer, ShadowMaps maps, const LightSettings& settings,
                 const RenderOptions& options, VirtualLights* lights);

}  // namespace lobelia::app
