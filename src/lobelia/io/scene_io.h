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
  std::string sky;      // "turbidity,x,y,z": sun and sky in place of the scene's environment
  float time = 0;       // seconds: animated scenes (glTF) are taken at this time
  std::string variant;  // material variant (glTF); must exist when given
};

// Any supported scene by its extension; throws InputError. Warnings are in Scene::findings.
Scene readScene(const std::string& file, const ReadSettings& settings, Context& context);
// Adds ReadSettings::environment (when given) as the scene's environment, in place of one it has.
// readScene() does this; built-in scenes need it too.
void applyEnvironment(Scene& scene, const ReadSettings& settings);
Scene readGltf(const std::string& file, const ReadSettings& settings, Context& context);  // .gltf, .glb
Scene readPbrt(const std::string& file, const ReadSettings& settings, Context& context);  // PBRT-v4
// OBJ (with its MTL files) or PLY as a scene.
Scene readBareMesh(const std::string& file, const ReadSettings& settings, Context& context);
// A camera that frames the scene when it has none, and a neutral environment when nothing shines.
// Says both in the findings.
void addDefaultView(Scene& scene);
Scene readMitsuba(const std::string& file, const ReadSettings& settings, Context& context);
// scene.xml plus meshes/ and textures/ in a folder; reads back identically.
void writeMitsuba(const std::string& folder, const Scene& scene);

}  // namespace lobelia::io
