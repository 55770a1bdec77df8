// What lobes too smooth for light samples show: a ray for each pixel, on through further mirrors
// and panes, to surfaces in the light of one bounce and to emitters themselves. Rays do not meet
// point-like emitters: their highlights are direct light of all lobes (LocalTile::addDirect).
#pragma once

#include "lobelia/relight/local_tile.h"

namespace lobelia::relight {

// Roughness below which a lobe is followed by a ray. Its reflections are about 0.1 radians wide:
// light samples a room's thirtieth apart are as wide from a metre away.
inline constexpr float kSmoothest = 0.07f;

// Adds to up to 16 pixels what their sharp lobes show. Returns the rays traced.
uint64_t addMirrored(const LocalInput& input, std::span<LitPixel> pixels);

}  // namespace lobelia::relight
