// Where a light stands in the picture, and where it goes when its mark is dragged.
#pragma once

#include <optional>

#include "lobelia/scene/camera.h"

namespace lobelia::app {

// Pixels of the film, not only of its inside; empty behind the camera.
std::optional<Vec2f> project(const Camera& camera, Vec3f point);
// The point moved across the view so that it is seen `pixels` further.
Vec3f movedAcross(const Camera& camera, Vec3f point, Vec2f pixels);
// The point moved along the line from the camera, by a share of its distance: -0.5 is half way.
Vec3f movedAlong(const Camera& camera, Vec3f point, float share);

}  // namespace lobelia::app
