// Virtual spherical Gaussian lights of a set: points of the light pass or of reflective shadow
// maps, clustered as --vsgl-clusters says.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia::app {

// settings.count: lights aimed at. Points of different light groups, those on emitters and, where
// paths are limited, those of different depths are clustered apart. Books and counts as
// makeLights() does, "light_points" and seconds of "lights".
VirtualLights makeGaussianLights(const Tracer& tracer, const EmitterSampler& emitters,
                                 const LightSettings& settings, const RenderOptions& options,
                                 Context& context);

}  // namespace lobelia::app
