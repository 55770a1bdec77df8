// What the parts of the glTF reader share: the document, the scene that is filled, and what is said
// about it.
#pragma once

#include "lobelia/io/gltf/document.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::io::gltf {

struct Import {
  Document& document;
  Scene& scene;
  const ReadSettings& settings;

  void warn(const Json& where, std::string message) const {
    scene.findings.push_back({Severity::warning, where.where(), std::move(message)});
  }
  void inform(const Json& where, std::string message) const {
    scene.findings.push_back({Severity::info, where.where(), std::move(message)});
  }
};

// Checks asset.version, extensionsRequired (unknown: InputError) and extensionsUsed (unknown: a
// warning).
void checkAsset(const Import& import);
const std::vector<std::string>& knownExtensions();
bool isKnownExtension(const std::string& name);

// A warning for each key that glTF does not know where it stands.
void warnOfUnknownKeys(const Import& import);

}  // namespace lobelia::io::gltf
