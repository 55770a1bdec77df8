// Files that become edits of designs.
#pragma once

#include <memory>
#include <string>

#include "lobelia/app/studio/design.h"
#include "lobelia/io/design.h"

namespace lobelia::app {

struct ReadDesign {
  std::shared_ptr<const Design> design;
  io::DesignParts parts;
  size_t camera = 0;  // that the file brings, the first of several
};
// A design file applied to `base`. New lights without a name get one, so that the file replaces
// them when it is read again. Throws InputError, and of warnings where strict. Warnings go to the
// context.
ReadDesign readDesign(const Design& base, const std::string& file, bool strict, Context& context);

// Throws InputError.
std::shared_ptr<StoredImage> readImageFile(const std::string& file, bool raw);
// In place of the (first) environment that there is, as --environment does.
void setEnvironment(Design& design, std::shared_ptr<StoredImage> image);

}  // namespace lobelia::app
