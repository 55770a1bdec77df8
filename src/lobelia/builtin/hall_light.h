// A generated environment: a warm hall with tall windows and lamps (internal to this room).
#pragma once

#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

// As the scene's environment, turned about y.
void addHallLight(SceneBuilder& scene, double degrees);

}  // namespace lobelia::builtin
