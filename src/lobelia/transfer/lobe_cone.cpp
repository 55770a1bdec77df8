// With a micro-normal h at an angle t from n the reflected direction is at most 2 t from the mirror
// direction: two half turns about axes t apart are one turn by 2 t. So it is enough to know where
// the density of micro-normals, and what it is multiplied by, fall below the share.
//
// What the density is multiplied by is bounded as a whole: masking of the other direction is at
// most 1, transmittances of layers too; Fresnel factors have one minimum at most between two
// angles, so that they are largest at an end.
#include "lobelia/transfer/lobe_cone.h"

#include <algorithm>
#include <cmath>

#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia::transfer {
namespace {

// Angle whose squared tangent x solves e^(-x / alpha^2) (1 + x)^power = share. Where alpha is so
// large that this hardly falls: a right angle.
float gaussianSlopes(float alpha, int power, float share) {
  if (alpha > 0.35f) return kPi / 2;
  const float a2 = alpha * alpha, first = -std::log(share);
  float x = a2 * first;
  // A factor of 2 alpha^2 closer at each step.
  for (int i = 0; i < 8 && power > 0; ++i)
    x = a2 * (first + static_cast<float>(power) * std::log1p(x));
  return std::atan(std::sqrt(1.001f * x));
}

float angleOfSine(float squared) { return squared < 1 ? std::asin(std::sqrt(squared)) : kPi / 2; }
float angleOfCosine(float cosine) {
  return cosine > 0 ? std::acos(std::min(cosine, 1.f)) : kPi / 2;
}

// Angle from the normal at which the density of micro-normals is `share` of what it is there.
float densityAngle(Distribution distribution, float alpha, float share) {
  const float a2 = std::min(alpha * alpha, 0.999f), spread = a2 / (1 - a2);
  switch (distribution) {
    case Distribution::ggx:
      return angleOfSine((std::sqrt(1 / share) - 1) * spread);
    case Distribution::gtr1:
      return angleOfSine((1 / share - 1) * spread);
    case Distribution::beckmann:
      return gaussianSlopes(alpha, 2, share);
    case Distribution::phong:
      return angleOfCosine(std::exp(std::log(share) / std::max(2 / a2 - 2, 1e-3f)));
    case Distribution::sphericalGaussian:
      return angleOfCosine(1 + std::log(share) * alpha * alpha / 2);
  }
  return kPi / 2;
}

// Largest Fresnel factor of micro-normals up to `angle` from the normal over that of the normal.
float fresnelRise(const Lobe& lobe, Vec3f wo, bool behind, float angle) {
  const float incidence = std::acos(std::min(wo.z, 1.f));
  const float flat = std::cos(std::min(incidence + angle, kPi / 2));
  const float steep = std::cos(std::max(incidence - angle, 0.f));
  const Rgb most =
      max(fresnelOf(lobe, std::max(flat, 0.f), behind), fresnelOf(lobe, steep, behind));
  return maxComponent(most / max(fresnelOf(lobe, wo.z, behind), Rgb(1e-6f)));
}

float microfacetAngle(const Lobe& lobe, Vec3f wo, bool behind, float share) {
  float rest = core::smithMasking(lobe.distribution, lobe.alphaX, lobe.alphaY, toCore(wo));
  if (isCoated(lobe)) rest *= sqr(lookUpCoat(lobe.table, wo.z));
  if (lobe.distribution == Distribution::gtr1) rest *= wo.z;
  const float alpha = std::max(lobe.alphaX, lobe.alphaY);
  float angle = kPi / 2;
  // Micro-normals beyond the angle are out; what is within rises less.
  for (int i = 0; i < 3; ++i) {
    const float least = share * rest / std::max(fresnelRise(lobe, wo, behind, angle), 1.f);
    angle = std::min(densityAngle(lobe.distribution, alpha, std::max(least, 1e-30f)), angle);
  }
  return angle;
}

float wardAngle(const Lobe& lobe, Vec3f wo, float share) {
  const float alpha = std::max(lobe.alphaX, lobe.alphaY);
  if (lobe.variant == 0) return gaussianSlopes(alpha, 0, share * std::sqrt(wo.z));
  return gaussianSlopes(alpha, lobe.variant == 2 ? 1 : 0, share);
}

}  // namespace

float coneAngle(const Lobe& lobe, Vec3f wo, float share) {
  const bool behind = wo.z < 0;
  const Vec3f front = behind ? flipZ(wo) : wo;
  switch (lobe.type) {
    case LobeType::microfacetReflection:
      return 2 * microfacetAngle(lobe, front, behind && lobe.interface, share);
    case LobeType::ward:
      return 2 * wardAngle(lobe, front, share);
    case LobeType::phong:
      return angleOfCosine(
          std::exp(std::log(share * std::max(front.z, 1e-6f)) / std::max(lobe.alphaX, 1e-3f)));
    default:
      return kPi;
  }
}

}  // namespace lobelia::transfer
