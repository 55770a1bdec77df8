// Options of virtual spherical Gaussian lights (--vsgl-...), with their defaults filled in.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia::app {

void addVsglOptions(CLI::App& command, RenderOptions& options);
// Throws UsageError where they do not fit each other or the rest.
void requireVsgl(const RenderOptions& options);

GaussianShading gaussianShadingOf(const RenderOptions& options);
// Shadow rays of a receiver to lights chosen by what they would send it; below 0: one to every
// light.
int shadowRaysOf(const RenderOptions& options);
// Texels on a side of a light's shadow map; 0: rays.
int mapSizeOf(const RenderOptions& options);
// Points that `lights` clusters are made of.
size_t vsglPointsOf(const RenderOptions& options, size_t lights);

}  // namespace lobelia::app
