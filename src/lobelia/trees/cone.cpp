#include "lobelia/trees/cone.h"

#include "lobelia/base/frame.h"

namespace lobelia::trees {
namespace {

Vec3d toDouble(Vec3f v) { return {double{v.x}, double{v.y}, double{v.z}}; }

// Any unit vector at a right angle to `a`, towards b where that says which. In double precision,
// for axes that are nearly opposite.
Vec3d across(Vec3f a, Vec3f b) {
  const Vec3d from = toDouble(a), to = toDouble(b);
  const Vec3d side = to - from * (dot(from, to) / dot(from, from));
  const double l = length(side);
  return l > 1e-10 ? side / l : toDouble(frameFromNormal(a).s);
}

}  // namespace

float angleBetween(Vec3f a, Vec3f b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

Cone merged(const Cone& a, const Cone& b) {
  const Cone &wide = a.angle < b.angle ? b : a, &narrow = a.angle < b.angle ? a : b;
  const float apart = angleBetween(wide.axis, narrow.axis);
  if (std::min(kPi, apart + narrow.angle) <= wide.angle) return wide;
  const float angle = 0.5f * (wide.angle + narrow.angle + apart);
  if (angle >= kPi) return {wide.axis, kPi};
  const double turn = double{angle} - double{wide.angle};
  const Vec3d axis = normalize(toDouble(wide.axis) * std::cos(turn) +
                               across(wide.axis, narrow.axis) * std::sin(turn));
  return {{static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)},
          angle};
}

}  // namespace lobelia::trees
