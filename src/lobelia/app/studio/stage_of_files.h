// A stage of a scene's files and of what `lobelia precompute` made of it.
#pragma once

#include "lobelia/app/load_scene.h"
#include "lobelia/app/studio/stage.h"

namespace lobelia::app {

// Throws as loadScene() and Stage do; where data is refused because --design has other materials
// than it was made with, InputError names both.
Stage stageOf(const SceneOptions& scene, const std::vector<std::string>& data, Context& context);

}  // namespace lobelia::app
