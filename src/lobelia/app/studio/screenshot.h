// The picture of a view in a file.
#pragma once

#include <string>

#include "lobelia/app/studio/display_picture.h"

namespace lobelia::app {

// .exr: the film, linear, with all its layers and what made it; .png: as displayPicture() shows it.
// Whole or not at all. Throws UsageError for other names, RuntimeError when it cannot be written.
void writeScreenshot(const std::string& file, const Picture& picture, const Picture* truth,
                     const DisplaySettings& settings);

}  // namespace lobelia::app
