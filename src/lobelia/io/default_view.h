// Light for scenes that have none (internal to io; addDefaultView() is in scene_io.h).
#pragma once

#include <string>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

// Adds the studio environment, turned with the first camera; `why` begins the finding that says so.
void addStudio(Scene& scene, const std::string& why);

}  // namespace lobelia::io
