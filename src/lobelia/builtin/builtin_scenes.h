// The built-in procedural scenes.
#pragma once

#include <span>

#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

struct BuiltinScene {
  const char* name;
  Scene (*make)(float detail);  // use builtinScene(), which checks the detail and names the scene
  uint64_t triangles;           // at detail 1, within 10 %
  const char* description;      // one line
};

std::span<const BuiltinScene> builtinScenes();
std::vector<std::string> builtinSceneNames();
// detail scales the tessellation along an edge: triangles grow as its square. Throws UsageError
// with the known names. meshes: a folder of real meshes to take the place of stand-ins, if not empty
// (real_meshes.h).
Scene builtinScene(const std::string& name, float detail, const std::string& meshes = {});

}  // namespace lobelia::builtin
