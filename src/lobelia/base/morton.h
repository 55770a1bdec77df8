// Morton codes: numbers that put what is near in the plane or in space near in a row.
#pragma once

#include <algorithm>
#include <cstdint>

#include "lobelia/base/vec.h"

namespace lobelia {

// Interleaves the bits of x and y.
inline uint64_t morton(uint32_t x, uint32_t y) {
  const auto spread = [](uint64_t v) {
    v = (v | v << 16) & 0x0000ffff0000ffffull;
    v = (v | v << 8) & 0x00ff00ff00ff00ffull;
    v = (v | v << 4) & 0x0f0f0f0f0f0f0f0full;
    v = (v | v << 2) & 0x3333333333333333ull;
    return (v | v << 1) & 0x5555555555555555ull;
  };
  return spread(x) | spread(y) << 1;
}

// Ten bits of each coordinate of a point in [0, 1]^3; what is outside counts as the border.
inline uint32_t morton(Vec3f unit) {
  const auto spread = [](float v) {
    uint32_t x = static_cast<uint32_t>(std::clamp(v * 1024, 0.f, 1023.f));
    x = (x | x << 16) & 0x030000ffu, x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
  };
  return spread(unit.x) | spread(unit.y) << 1 | spread(unit.z) << 2;
}

}  // namespace lobelia
