// Looks into shadow maps of lights (depth_maps.h) for kLanes points.
//
// A map's texel knows the distance in the direction of its middle. A point is lit if its own
// surface, as a plane, would have been no further away in that direction than what the map has
// there, but for kSlack: planes do not shadow themselves, whatever the angle, and no bias has to be
// chosen for the scene.
#if defined(LOBELIA_GATHER_DEPTH_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_DEPTH_LOOKUP_INL_H_
#undef LOBELIA_GATHER_DEPTH_LOOKUP_INL_H_
#else
#define LOBELIA_GATHER_DEPTH_LOOKUP_INL_H_
#endif

#include "lobelia/base/simd-inl.h"
#include "lobelia/gather/depth_maps.h"

LOBELIA_CORE_BEGIN

// Share of the distance by which a point may be behind what a texel has, times texels: curved
// surfaces lie behind their tangent planes.
inline constexpr float kSlackTexels = 0.5f;

HWY_INLINE Vf withSign(Vf value, Vf sign) { return select(sign < Vf(0.f), Vf(0.f) - value, value); }

// Where a direction, of any length, is in [-1,1]² of an octahedral map [Cigolle14].
HWY_INLINE void octahedralPlace(V3<Vf> d, Vf* u, Vf* v) {
  const Vf inverse = Vf(1.f) / (abs(d.x) + abs(d.y) + abs(d.z));
  const Vf x = d.x * inverse, y = d.y * inverse;
  const Mf lower = d.z < Vf(0.f);
  *u = select(lower, withSign(Vf(1.f) - abs(y), x), x);
  *v = select(lower, withSign(Vf(1.f) - abs(x), y), y);
}

// octahedralDirection().
HWY_INLINE V3<Vf> octahedralDirection(Vf u, Vf v) {
  const Vf z = Vf(1.f) - abs(u) - abs(v);
  const Vf fold = max(Vf(0.f) - z, Vf(0.f));
  return {u - withSign(fold, u), v - withSign(fold, v), z};
}

// Are points p, of surfaces with normals ng, lit from `end`?
HWY_INLINE Mf depthMapLit(const float* map, int texels, V3<Vf> end, V3<Vf> p, V3<Vf> ng) {
  const V3<Vf> d = p - end;
  Vf u, v;
  octahedralPlace(d, &u, &v);
  const float side = static_cast<float>(texels);
  const Vf half(0.5f * side), last(side - 1);
  const Vf column = min(floor((u + Vf(1.f)) * half), last);
  const Vf row = min(floor((v + Vf(1.f)) * half), last);
  const Vf stored = gather(map, row * Vf(side) + column);
  const Vf step(2.f / side);
  const V3<Vf> middle =
      octahedralDirection((column + Vf(0.5f)) * step - Vf(1.f), (row + Vf(0.5f)) * step - Vf(1.f));
  const Vf distance = sqrt(dot(d, d));
  // The point's plane in the direction of the texel's middle; never nearer than behind the light.
  const Vf along = dot(ng, d) * sqrt(dot(middle, middle)), towards = dot(ng, middle);
  const Vf plane = select(along * towards > Vf(0.f), along / towards, distance);
  return stored >= min(plane, distance) * Vf(1 - kSlackTexels / side);
}

LOBELIA_CORE_END

#endif  // per-target include guard
