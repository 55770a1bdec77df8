// The order of virtual lights within a depth.
#pragma once

#include <vector>

#include "lobelia/lights/light_point.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia {

// Puts diffuse, glossy, spherical and Gaussian lights, which are sorted by depth, in each depth
// along a Morton curve: neighbours in the array are neighbours in the scene, so that shadow rays to
// a block of lights are coherent and the near fields of a block lie together. Their groups go
// along. bounds: of the scene.
void sortByPlace(const Bounds3f& bounds, VirtualLights* lights);

// Light points by group, then depth; those of one of each keep their order.
void sortByGroup(std::vector<LightPoint>* points);

}  // namespace lobelia
