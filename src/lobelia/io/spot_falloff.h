// Spot lights whose intensity is any function of the angle from their axis.
#pragma once

#include <functional>
#include <string>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

// Cutoffs, in radians, above which a picture on the tangent plane would be too coarse.
inline constexpr float kWidestSpot = 75 * kPi / 180;

// The intensity towards an angle of this cosine, as a factor of the light's.
using SpotFalloff = std::function<double(double cosine)>;

// Makes `light`, whose intensity and place are set, a spot of this cutoff (radians): `falloff` is a
// picture on its tangent plane or, above kWidestSpot, the image of a goniometric light.
// `name` stands for the falloff: spots of the same name and cutoff share their picture.
void shapeSpot(Scene& scene, Emitter& light, float cutoff, const std::string& name,
               const SpotFalloff& falloff);

}  // namespace lobelia::io
