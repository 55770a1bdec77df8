// A field for a file's path, with what lies in its folder to choose from.
#pragma once

#include <span>
#include <string>

#include "lobelia/app/viewer/window/widgets.h"

namespace lobelia::app {

// endings: of files that are offered, as ".png". True when a path was entered or a file chosen.
bool fileField(Widgets& widgets, const std::string& label, std::string& path,
               std::span<const char* const> endings);

inline constexpr const char* kImageEndings[]{".png", ".jpg", ".jpeg", ".exr", ".hdr", ".tga",
                                             ".bmp", ".tif", ".tiff", ".pfm", ".ppm"};
inline constexpr const char* kEnvironmentEndings[]{".hdr", ".exr", ".pfm"};
inline constexpr const char* kDesignEndings[]{".xml"};
inline constexpr const char* kPictureEndings[]{".exr", ".png"};

}  // namespace lobelia::app
