// Whole files in and out: reading at once, and writing so that a file is there whole or not at all.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "lobelia/base/error.h"

namespace lobelia::io {

// Contents of a regular file. Throws InputError at `from` (the place that names the file) when it
// cannot be read; `what` says what it was to be: "mesh", "image".
std::string readFileBytes(const std::string& file, const std::string& what, const Location& from);

// Calls write(temporary name in the same folder, with the same extension), then syncs and renames
// to `file`. Whatever fails, the temporary is removed, `file` is as it was, and RuntimeError says
// why; write() may throw it itself.
void writeAtomically(const std::string& file,
                     const std::function<void(const std::string& temporary)>& write);
// The same for bytes that are all in memory.
void writeFileAtomically(const std::string& file, const std::string& bytes);

}  // namespace lobelia::io
