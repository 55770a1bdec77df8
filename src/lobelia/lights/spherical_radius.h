// Radii of spherical lights [Hasan09 section 3.3].
#pragma once

#include "lobelia/lights/light_pass.h"
#include "lobelia/scene/shading.h"
#include "lobelia/trace/tracer.h"

namespace lobelia {

// Distance of every light's tenth nearest neighbour among lights on similarly oriented surface
// (normals on the lit side within 26 degrees), in the order of the lights; where there are fewer,
// what the density of those there are gives; where there is no other at all, a tenth of the scene's
// radius. Never 0.
std::vector<float> tenthNeighbourDistances(const Tracer& tracer,
                                           const std::vector<SphericalLight>& lights);

// The geometric normal on the side that a light's power came from.
Vec3f litNormal(const SurfacePoint& at, const SphericalLight& light);

// Sets the radius of every light: that distance times settings.radiusFactor and radiusScale.
// radiusFactor 0: twice that distance, and where the picture is the mean of several sets less where
// other surface is near: light changes over lengths of its distance. Counts "path_rays".
void chooseRadii(const Tracer& tracer, const LightSettings& settings, VirtualLights* lights,
                 Context& context);

}  // namespace lobelia
