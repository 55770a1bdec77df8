// Radii of spherical lights [Hasan09 section 3.3].
#pragma once

#include "lobelia/lights/light_pass.h"
#include "lobelia/scene/scene.h"

namespace lobelia {

// Distance of every light's tenth nearest neighbour among lights on similarly oriented surface
// (normals on the lit side within 26 degrees), in the order of the lights; where there are fewer,
// what the density of those there are gives. Never 0.
std::vector<float> tenthNeighbourDistances(const Scene& scene,
                                           const std::vector<SphericalLight>& lights);

// Sets the radius of every light: that distance times settings.radiusFactor (0: kAutomaticFactor of
// the .cpp) and radiusScale.
void chooseRadii(const Scene& scene, const LightSettings& settings, VirtualLights* lights);

}  // namespace lobelia
