// The kernels of kernels-inl.h applied to Lobe records, for the scalar files of this room.
// Directions are in the lobe's frame (n = +z). Not for public headers (base/core-inl.h says why).
#pragma once

#include "lobelia/bsdf/kernels-inl.h"
#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia {

inline core::V3<float> toCore(Vec3f v) { return {v.x, v.y, v.z}; }
inline Vec3f fromCore(core::V3<float> v) { return {v.x, v.y, v.z}; }

inline core::LobeTags tagsOf(const Lobe& lobe) {
  return {lobe.type, lobe.distribution, lobe.fresnel, lobe.variant};
}
inline core::LobeParameters<float> parametersOf(const Lobe& lobe) {
  return {lobe.alphaX,         lobe.alphaY,
          toCore(lobe.weight), toCore(lobe.eta),
          toCore(lobe.k),      toCore(lobe.parameters),
          toCore(lobe.tint),   lobe.interface ? 2.f : (lobe.twoSided ? 1.f : 0.f)};
}

// Transmittance of a rough coat, linear between the entries of its table.
inline float lookUpCoat(const float* table, float cosine) {
  const float x = std::max(cosine, 0.f) * static_cast<float>(kTransmittanceSize - 1);
  const int i = std::min(static_cast<int>(x), kTransmittanceSize - 2);
  const float f = x - static_cast<float>(i);
  return table[i] * (1 - f) + table[i + 1] * f;
}

// f |cos| of a non-delta lobe, radiance transport.
inline Rgb evaluateLobe(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const float* table = lobe.table;
  return fromCore(core::evaluateLobe(tagsOf(lobe), parametersOf(lobe), toCore(wo), toCore(wi),
                                     [table](float c) { return lookUpCoat(table, c); }));
}

// Fresnel factor at a micro-normal; behind: an interface seen from inside.
inline Rgb fresnelOf(const Lobe& lobe, float cosine, bool behind) {
  return fromCore(
      core::fresnelReflectance(lobe.fresnel, parametersOf(lobe), cosine, behind ? 1.f : 0.f));
}

// Do layers with the transmittance Lobe::table lie over the lobe?
inline bool isCoated(const Lobe& lobe) {
  const bool may = lobe.type == LobeType::sheen || lobe.type == LobeType::thinTransmission ||
                   lobe.type == LobeType::microfacetReflection ||
                   lobe.type == LobeType::microfacetTransmission;
  return may && (lobe.variant & kCoated) != 0;
}
inline bool isDelta(const Lobe& lobe) { return isDelta(lobe.type); }
inline bool isTransmission(const Lobe& lobe) { return isTransmission(lobe.type); }
// Does the lobe act for a wo on this side at all?
inline bool isActive(const Lobe& lobe, float cosThetaO) {
  return cosThetaO > 0 || (cosThetaO < 0 && (lobe.twoSided || lobe.interface));
}
// n(other side) / n(side of wo) of an interface.
inline float relativeEta(const Lobe& lobe, bool behind) {
  return behind && lobe.interface ? 1 / lobe.eta.x : lobe.eta.x;
}
// Mirrors a direction at the tangent plane.
inline Vec3f flipZ(Vec3f v) { return {v.x, v.y, -v.z}; }

}  // namespace lobelia
