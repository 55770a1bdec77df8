#include "lobelia/io/findings.h"

namespace lobelia::io {

void Findings::warn(const Location& where, const std::string& message) {
  if (strict_) throw InputError(where, message + " (--strict)");
  out_.push_back({Severity::warning, where, message});
}

void Findings::add(const std::vector<Finding>& findings) {
  for (const Finding& f : findings) {
    if (f.severity == Severity::warning) {
      warn(f.where, f.message);
    } else {
      out_.push_back(f);
    }
  }
}

}  // namespace lobelia::io
