// Cones of directions: all within an angle of an axis.
#pragma once

#include "lobelia/base/vec.h"

namespace lobelia::trees {

struct Cone {
  Vec3f axis{0, 0, 1};  // unit
  float angle = 0;      // radians, [0, pi]; pi: all directions
};

// Angle between unit vectors, by atan2: exact for small and for nearly flat angles, too.
float angleBetween(Vec3f a, Vec3f b);
// The smallest cone that holds both, but for rounding.
Cone merged(const Cone& a, const Cone& b);

}  // namespace lobelia::trees
