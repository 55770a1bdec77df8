// A tile's pixels in groups of neighbours, for the choice of its light cut.
#pragma once

#include <span>
#include <vector>

#include "lobelia/relight/group_error.h"
#include "lobelia/relight/lit_pixel.h"

namespace lobelia::relight {

inline constexpr size_t kGroupPixels = 16;

// pixels: in an order in which those in a row are neighbours.
void makePixelGroups(std::span<const LitPixel> pixels, std::vector<PixelGroup>* groups);

}  // namespace lobelia::relight
