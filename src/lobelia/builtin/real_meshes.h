// Real meshes in place of the stand-ins of built-in scenes.
#pragma once

#include <string>

#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

// Replaces every mesh of the scene that stands in for a well-known one (dragon, monkey, hare,
// teapot) by the file of that name in the folder: scaled alike in all directions into the
// stand-in's bounding box, in the middle of its floor. What was taken, and what is missing and
// stays, is added to the scene's findings. Throws InputError when the folder does not exist or a
// mesh in it is broken or has no extent.
void useRealMeshes(Scene& scene, const std::string& folder);

}  // namespace lobelia::builtin
