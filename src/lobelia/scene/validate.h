// Parts of validate(), one per kind of data; private to the room.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::validation {

class Findings {
 public:
  explicit Findings(std::string file) : file_(std::move(file)) {}
  void error(std::string message) { add(Severity::error, std::move(message)); }
  void warning(std::string message) { add(Severity::warning, std::move(message)); }
  std::vector<Finding> take() { return std::move(list_); }

 private:
  void add(Severity severity, std::string message) {
    list_.push_back({severity, {file_, 0, 0}, std::move(message)});
  }
  std::string file_;
  std::vector<Finding> list_;
};

// "mesh 'name'" or "mesh 3" for things without a name.
std::string label(const char* kind, const std::string& name, size_t index);

// False when a handle inside is out of range: what follows it must then not be looked at.
bool checkTextures(const Scene& scene, Findings& findings);
bool checkMaterials(const Scene& scene, bool texturesValid, Findings& findings);
void checkLobes(const Scene& scene, Findings& findings);  // of materials found valid
void checkMeshes(const Scene& scene, Findings& findings);
void checkInstances(const Scene& scene, Findings& findings);
void checkEmitters(const Scene& scene, Findings& findings);
void checkCameras(const Scene& scene, Findings& findings);

}  // namespace lobelia::validation
