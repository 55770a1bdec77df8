// Orthonormal frames.
#pragma once

#include "lobelia/base/vec.h"

namespace lobelia {

// s, t, n: right-handed and orthonormal. Local directions have n as z.
struct Frame {
  Vec3f s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};
  Vec3f toLocal(Vec3f v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3f toWorld(Vec3f v) const { return s * v.x + t * v.y + n * v.z; }
};

// Branch-free frame around a unit vector (Duff et al. 2017, "Building an Orthonormal Basis,
// Revisited", JCGT 6(1)).
inline Frame frameFromNormal(Vec3f n) {
  const float sign = std::copysign(1.f, n.z);
  const float a = -1 / (sign + n.z);
  const float b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

// Frame with normal n (unit) whose s is the part of `tangent` that is orthogonal to n. Falls back
// to frameFromNormal where the tangent is (nearly) parallel to n or zero.
inline Frame frameFromNormalTangent(Vec3f n, Vec3f tangent) {
  const Vec3f s = tangent - n * dot(n, tangent);
  const float len2 = lengthSquared(s);
  if (!(len2 > 1e-12f * lengthSquared(tangent)) || !std::isfinite(len2)) return frameFromNormal(n);
  Vec3f sn = s / std::sqrt(len2);
  // Once more: what rounding left along n counts when the tangent was nearly parallel to it.
  if (len2 < 0.25f * lengthSquared(tangent)) sn = normalize(sn - n * dot(n, sn));
  return {sn, cross(n, sn), n};
}

}  // namespace lobelia
