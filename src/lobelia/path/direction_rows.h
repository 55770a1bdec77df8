// Matrices that turn directions, made safe for floats: what becomes of a direction does not depend
// on a matrix's overall scale, so it is divided out. (Squares of entries like 1e30 overflow.)
#pragma once

#include <algorithm>
#include <cmath>

#include "lobelia/base/transform.h"

namespace lobelia {

struct DirectionRows {
  Vec3f rows[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  float determinant = 1;  // its absolute value

  DirectionRows() = default;
  // The upper-left 3x3 part of m over its largest entry.
  explicit DirectionRows(const Mat4& m) {
    double largest = 0;
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(m.m[r][c]));
    if (!(largest > 0) || !std::isfinite(largest)) largest = 1;
    Mat4 scaled;
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) scaled.m[r][c] = m.m[r][c] / largest;
      rows[r] = {static_cast<float>(scaled.m[r][0]), static_cast<float>(scaled.m[r][1]),
                 static_cast<float>(scaled.m[r][2])};
    }
    determinant = static_cast<float>(std::abs(scaled.determinant3()));
  }

  Vec3f operator*(Vec3f d) const { return {dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)}; }
};

}  // namespace lobelia
