// Where the readers' warnings go.
#pragma once

#include <string>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

// Strict: a warning throws InputError instead.
class Findings {
 public:
  Findings(std::vector<Finding>& out, bool strict) : out_(out), strict_(strict) {}
  void warn(const Location& where, const std::string& message);
  // A choice that a reader made, worth knowing; never an error.
  void inform(const Location& where, const std::string& message) {
    out_.push_back({Severity::info, where, message});
  }
  // Takes over what a mesh reader had to say.
  void add(const std::vector<Finding>& findings);

 private:
  std::vector<Finding>& out_;
  bool strict_;
};

}  // namespace lobelia::io
