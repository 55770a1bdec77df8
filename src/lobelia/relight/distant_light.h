// Light from infinity as a list of directed powers: what the environments, suns and directional
// emitters of a scene send to a point, before it is shared out to the light samples.
#pragma once

#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::relight {

// Light from around one direction: radiance times solid angle.
struct DirectedPower {
  Vec3f direction;  // unit, towards the light
  Rgb power;
};

struct DistantLight {
  Rgb everywhere{};                   // radiance of constant environments
  std::vector<DirectedPower> powers;  // of all others
};

// Environments are cut into cells, some 130,000 each (four for every sample that there is by
// default), whose light is as the path tracer has it (EnvironmentSampler); a cell's direction is
// the mean of its light. Directional emitters and suns are one direction each, with their
// irradiance. Other emitters are left out.
DistantLight distantLight(const Scene& scene);

}  // namespace lobelia::relight
