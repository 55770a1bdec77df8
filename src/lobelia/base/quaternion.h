// Rotations as unit quaternions (Shoemake 1985), for interpolation.
#pragma once

#include "lobelia/base/transform.h"

namespace lobelia {

struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

// Of the upper-left 3x3 part, which must be a rotation (orthonormal, determinant 1).
Quaternion quaternion(const Mat4& rotation);
Mat4 rotation(const Quaternion& q);
// Along the shorter great arc: a at t = 0, b at 1; goes on beyond both for other t.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);
// Angle of the rotation that takes a to b, in [0, pi].
double angleBetween(const Quaternion& a, const Quaternion& b);

}  // namespace lobelia
