// The built-in procedural scenes.
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

std::vector<std::string> builtinSceneNames();
// detail scales the tessellation. Throws UsageError with the known names.
Scene builtinScene(const std::string& name, float detail);

}  // namespace lobelia::builtin
