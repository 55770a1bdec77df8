// Warps from the unit square to the usual domains.
#include "lobelia/base/sampling.h"

namespace lobelia {

Vec2f sampleDiskConcentric(Vec2f u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {0, 0};
  // Squares around the centre become circles; the angle is proportional to the way along the side.
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y;
  const float angle = wide ? (kPi / 4) * (y / x) : kPi / 2 - (kPi / 4) * (x / y);
  return {r * std::cos(angle), r * std::sin(angle)};
}

Vec3f sampleHemisphereCosine(Vec2f u) {
  const Vec2f d = sampleDiskConcentric(u);
  return {d.x, d.y, std::sqrt(std::max(0.f, 1 - d.x * d.x - d.y * d.y))};
}

Vec3f sampleSphereUniform(Vec2f u) { return sampleConeUniform(u, 2); }

Vec3f sampleConeUniform(Vec2f u, float oneMinusCosMax) {
  // t = 1 - cos keeps narrow cones exact: sin = sqrt(t (2 - t)).
  const float t = u.x * oneMinusCosMax;
  const float r = std::sqrt(std::max(0.f, t * (2 - t)));
  const float phi = kTwoPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1 - t};
}

Vec2f sampleTriangleUniform(Vec2f u) {
  const float s = std::sqrt(u.x);
  return {1 - s, u.y * s};
}

}  // namespace lobelia
