// base/file.h for bytes in a string, with messages that say what the file was to be.
#pragma once

#include <string>

#include "lobelia/base/error.h"

namespace lobelia::io {

// Contents of a regular file. Throws InputError at `from` (the place that names the file) when it
// cannot be read; `what` says what it was to be: "mesh", "image".
std::string readFileBytes(const std::string& file, const std::string& what, const Location& from);

void writeFileAtomically(const std::string& file, const std::string& bytes);

}  // namespace lobelia::io
