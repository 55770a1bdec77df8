// Errors of a node of light in registers of pixel groups (group_error.h).
#if defined(LOBELIA_RELIGHT_GROUP_ERROR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_RELIGHT_GROUP_ERROR_INL_H_
#undef LOBELIA_RELIGHT_GROUP_ERROR_INL_H_
#else
#define LOBELIA_RELIGHT_GROUP_ERROR_INL_H_
#endif

#include <algorithm>

#include "lobelia/base/simd-inl.h"
#include "lobelia/relight/group_error.h"

LOBELIA_CORE_BEGIN

HWY_INLINE V3<Vf> loadLanes(const relight::GroupLanes::Lane (&values)[3], size_t at) {
  return {Vf::load(values[0].data() + at), Vf::load(values[1].data() + at),
          Vf::load(values[2].data() + at)};
}
HWY_INLINE V3<Vf> absolute(V3<Vf> v) { return {abs(v.x), abs(v.y), abs(v.z)}; }
HWY_INLINE V3<Vf> everywhere(Vec3f v) { return {Vf(v.x), Vf(v.y), Vf(v.z)}; }

HWY_INLINE Vf errors(const relight::GroupLanes& g, size_t at, const relight::NodeShape& node,
                     float softening) {
  const Vf zero(0.f), one(1.f), tilt(node.tilt);
  const V3<Vf> half = loadLanes(g.half, at);
  const V3<Vf> to = everywhere(node.place) - loadLanes(g.centre, at);
  const V3<Vf> far = absolute(to) - half;
  const V3<Vf> beyond{max(far.x, zero), max(far.y, zero), max(far.z, zero)};
  const Vf d2 = dot(beyond, beyond) + Vf(softening), inverse = one / sqrt(d2);
  const Vf angle = Vf(node.radius) * inverse, wide = min(angle, one);
  // Cosines at the pixels and at the node, at most: what lies in one plane sends itself no light.
  const V3<Vf> n = loadLanes(g.normal, at), m = everywhere(node.normal);
  const relight::Spread& s = node.spread;
  const Vf high2 = n.x * n.x * Vf(s.xx) + n.y * n.y * Vf(s.yy) + n.z * n.z * Vf(s.zz) +
                   Vf(2.f) * (n.x * n.y * Vf(s.xy) + n.x * n.z * Vf(s.xz) + n.y * n.z * Vf(s.yz));
  const Vf above =
      dot(n, to) + dot(absolute(n), half) + Vf(relight::NodeShape::kReach) * sqrt(max(high2, zero));
  const Vf receiver = min(above * inverse + Vf::load(g.bend.data() + at), one);
  const Vf before = dot(absolute(m), half) - dot(m, to) + Vf(node.thickness);
  const Vf sender = min(before * inverse + tilt * (one + angle), one);
  // Never nothing where light may come: largestError() also tells whether it does.
  const Vf diffuse = receiver * (wide + tilt + Vf(1e-6f));
  const V3<Vf> apart = to * (one / sqrt(max(dot(to, to), Vf(1e-30f)))) - loadLanes(g.axis, at);
  const Vf reach = Vf::load(g.chord.data() + at) + wide + Vf::load(g.size.data() + at) * inverse;
  const Vf glossy =
      select(dot(apart, apart) < reach * reach,
             Vf::load(g.peak.data() + at) * min(wide / Vf::load(g.width.data() + at), one), zero);
  const Mf lit = (receiver > zero) & (sender > zero);
  return select(lit, (diffuse + glossy) * sender / d2, zero);
}

inline float largestError(const relight::GroupLanes& groups, const relight::NodeShape& node,
                          float softening) {
  Vf most(0.f);
  for (size_t at = 0; at < relight::GroupLanes::kMost; at += kLanes)
    most = max(most, errors(groups, at, node, softening));
  alignas(64) float lanes[kLanes];
  most.store(lanes);
  return *std::max_element(lanes, lanes + kLanes);
}

LOBELIA_CORE_END

#endif  // per-target include guard
