// Directions on the faces of a cube, by coordinates in [-1, 1] that are nearly proportional to
// angles. Smooth within a face and some way beyond its edges, so that maps with a border of texels
// that lie beyond the edges are interpolated as well there as elsewhere. (The octahedral map has
// kinks along the borders of octants, at which bilinear interpolation errs in the first order.)
#pragma once

#include <array>
#include <cmath>

#include "lobelia/base/vec.h"

namespace lobelia::transfer {

struct CubePlace {
  size_t face = 0;  // 2 times the axis and 1 on its negative side
  Vec2f at;
};

// 4 / pi atan(t) to within .001; any smooth function that both ways agree on would do.
inline float warped(float t) {
  const float q = t * t;
  return t * (1.2664f - q * (0.3674f - q * 0.101f));
}
// t for |w| <= 1.2.
inline float unwarped(float w) {
  float t = std::tan(0.25f * kPi * w);
  for (int i = 0; i < 3; ++i) {
    const float q = t * t;
    t -= (warped(t) - w) / (1.2664f - q * (3 * 0.3674f - q * (5 * 0.101f)));
  }
  return t;
}

// d: not zero, of any length.
inline CubePlace cubePlace(Vec3f d) {
  const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  if (x >= y && x >= z) return {d.x < 0 ? 1u : 0u, {warped(d.y / x), warped(d.z / x)}};
  if (y >= z) return {d.y < 0 ? 3u : 2u, {warped(d.z / y), warped(d.x / y)}};
  return {d.z < 0 ? 5u : 4u, {warped(d.x / z), warped(d.y / z)}};
}

// Unit. u, v: unwarped.
inline Vec3f cubeDirection(size_t face, float u, float v) {
  const float sign = face % 2 == 0 ? 1.f : -1.f;
  const std::array<Vec3f, 3> of{Vec3f(sign, u, v), Vec3f(v, sign, u), Vec3f(u, v, sign)};
  return normalize(of[face / 2]);
}

}  // namespace lobelia::transfer
