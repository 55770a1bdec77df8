// Warps from the unit square to the usual domains.
#include "lobelia/base/sampling.h"

namespace lobelia {

Vec3f sampleSphereUniform(Vec2f u) { return sampleConeUniform(u, 2); }

Vec3f sampleConeUniform(Vec2f u, float oneMinusCosMax) {
  // t = 1 - cos keeps narrow cones exact: sin = sqrt(t (2 - t)).
  const float t = u.x * oneMinusCosMax;
  const float r = std::sqrt(std::max(0.f, t * (2 - t)));
  const float phi = kTwoPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1 - t};
}

}  // namespace lobelia
