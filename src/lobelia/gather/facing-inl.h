// Which receiver points and virtual lights can see each other's front: the tests that decide
// whether a shadow ray is worth tracing. All are exact but for
// Gaussian lights, whose tails they cut off: a pair that fails contributes zero.
#if defined(LOBELIA_GATHER_FACING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_FACING_INL_H_
#undef LOBELIA_GATHER_FACING_INL_H_
#else
#define LOBELIA_GATHER_FACING_INL_H_
#endif

#include "lobelia/base/simd-inl.h"
#include "lobelia/gather/light_block.h"
#include "lobelia/gather/tile.h"

LOBELIA_CORE_BEGIN

namespace g = ::lobelia::gather;

HWY_INLINE V3<Vf> load(const g::StripV3& v, size_t lane) {
  return {Vf::load(v.x + lane), Vf::load(v.y + lane), Vf::load(v.z + lane)};
}
HWY_INLINE V3<Vf> broadcast(Vec3f v) { return {Vf(v.x), Vf(v.y), Vf(v.z)}; }

HWY_INLINE Vf squaredDistance(V3<Vf> a, V3<Vf> b) {
  const V3<Vf> d = a - b;
  return dot(d, d);
}

// From the points to the light, not normalised except for directional lights.
template <g::LightClass kClass>
HWY_INLINE V3<Vf> toLight(const g::PreparedLight& light, V3<Vf> p) {
  if constexpr (kClass == g::LightClass::directional) return broadcast(light.p);
  return broadcast(light.p) - p;
}

// Does the light send anything along -d?
template <g::LightClass kClass>
HWY_INLINE Mf lightFaces(const g::PreparedLight& light, V3<Vf> d) {
  if constexpr (kClass == g::LightClass::directional) return Vf(0.f) == Vf(0.f);
  const Vf d2 = dot(d, d);
  Mf faces = d2 > Vf(0.f);
  if constexpr (kClass == g::LightClass::diffuse || kClass == g::LightClass::glossy) {
    faces = faces & (dot(broadcast(light.n), d) < Vf(0.f));
  }
  if constexpr (kClass == g::LightClass::glossy) {
    // cos |cos| > c |c| with cos = -axis.d / |d|: monotone, needs no root.
    const Vf q = Vf(0.f) - dot(broadcast(light.axis), d);
    faces = faces & (q * abs(q) > Vf(light.cutoff) * d2);
  }
  if constexpr (kClass == g::LightClass::spherical) {
    faces = faces & (d2 >= Vf(light.reach.from)) & (d2 < Vf(light.reach.to));
    if (!light.transmits) faces = faces & (dot(broadcast(light.n), d) < Vf(0.f));
  }
  if constexpr (kClass == g::LightClass::gaussian) {
    // cos |cos| > c |c|, as above.
    const Vf q = Vf(0.f) - dot(broadcast(light.n), d);
    faces = faces & (q * abs(q) >= Vf(light.cutoff) * d2);
  }
  return faces;
}

// Is any part of the light left to the gather?
template <g::LightClass kClass>
HWY_INLINE Mf beyondNear(const g::PointStrip& strip, size_t lane, V3<Vf> d) {
  if (!g::hasShares(kClass) || !strip.near) return Vf(0.f) == Vf(0.f);
  return dot(d, d) > Vf::load(strip.squaredNear + lane);
}

// Share of the light that is left to the gather (gatheredShare()).
HWY_INLINE Vf gatheredShare(const g::PointStrip& strip, size_t lane, Vf distance) {
  return min(max(distance * Vf::load(strip.nearScale + lane) - Vf(1.f), Vf(0.f)), Vf(1.f));
}

// Can the points scatter light that comes along d, or within `extent` of its end, towards their wo?
HWY_INLINE Mf receiverFaces(const g::PointStrip& strip, size_t lane, V3<Vf> d, float extent) {
  const Vf c = dot(load(strip.n, lane), d), slack(extent);
  const Vf above = Vf::load(strip.above + lane), below = Vf::load(strip.below + lane);
  Mf faces = ((c + slack) * above > Vf(0.f)) | ((c - slack) * below < Vf(0.f));
  // Bump maps: normal and perturbed normal must agree about the side (bsdf/lobe.h).
  if (strip.perturbed) faces = faces & (c * dot(load(strip.base, lane), d) > Vf(0.f));
  return faces;
}

LOBELIA_CORE_END

#endif  // per-target include guard
