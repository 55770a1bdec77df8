// Environments made by code (internal to this room).
#pragma once

#include <functional>

#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

// Radiance in a unit direction, y up.
using Radiance = std::function<Rgb(Vec3f)>;

// Equirectangular, 2 height x height, nine samples to a pixel.
Image environmentImage(int height, const Radiance& radiance, std::string name);
// An environment that lights the scene, turned about y.
void addEnvironment(SceneBuilder& scene, Image image, double degrees, std::string name);

// A photographer's dark studio: large soft boxes above and at the side, a strip, a light backdrop.
void addStudioLight(SceneBuilder& scene, double degrees);

}  // namespace lobelia::builtin
