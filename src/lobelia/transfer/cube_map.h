// Directions on the faces of a cube, by coordinates in [-1, 1] that are nearly proportional to
// angles. Smooth within a face and some way beyond its edges, so that maps with a border of texels
// that lie beyond the edges are interpolated as well there as elsewhere. (The octahedral map has
// kinks along the borders of octants, at which bilinear interpolation errs in the first order.)
// Not for headers, for it includes a core one.
#pragma once

#include <array>
#include <cmath>

#include "lobelia/base/vec.h"
#include "lobelia/transfer/interpolation-inl.h"

namespace lobelia::transfer {

// t for |w| <= 1.2, of which core::warpedTangent() makes w: 4 / pi atan(t) to within .001; any
// smooth function that both ways agree on would do.
inline float unwarped(float w) {
  float t = std::tan(0.25f * kPi * w);
  for (int i = 0; i < 3; ++i) {
    const float q = t * t;
    t -= (core::warpedTangent(t) - w) / (1.2664f - q * (3 * 0.3674f - q * (5 * 0.101f)));
  }
  return t;
}

// Unit. u, v: unwarped.
inline Vec3f cubeDirection(size_t face, float u, float v) {
  const float sign = face % 2 == 0 ? 1.f : -1.f;
  const std::array<Vec3f, 3> of{Vec3f(sign, u, v), Vec3f(v, sign, u), Vec3f(u, v, sign)};
  return normalize(of[face / 2]);
}

}  // namespace lobelia::transfer
