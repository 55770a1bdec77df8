// Scene files in and out.
#pragma once

#include <map>
#include <string>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

struct ReadSettings {
  std::map<std::string, std::string> definitions;  // -D name=value
  bool strict = false;                             // warnings are errors
  std::string environment;                         // HDR file added to (or replacing) the environment
};

// Any supported scene by its extension; throws InputError. Warnings are in Scene::findings.
Scene readScene(const std::string& file, const ReadSettings& settings, Context& context);
// Adds ReadSettings::environment (when given) as the scene's environment, in place of one it has.
// readScene() does this; built-in scenes need it too.
void applyEnvironment(Scene& scene, const ReadSettings& settings);
Scene readMitsuba(const std::string& file, const ReadSettings& settings, Context& context);
// scene.xml plus meshes/ and textures/ in a folder; reads back identically.
void writeMitsuba(const std::string& folder, const Scene& scene);

// Built-in procedural scenes: name -> scene. detail scales the tessellation.
std::vector<std::string> builtinSceneNames();
Scene builtinScene(const std::string& name, float detail);  // throws UsageError with the known names

}  // namespace lobelia::io
