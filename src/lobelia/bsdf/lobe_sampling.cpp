#include "lobelia/bsdf/lobe_sampling.h"

#include <cmath>

#include "lobelia/base/frame.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/microfacet_sampling.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

// Density of wi when its micro-normal has density pdfNormal.
float reflectionJacobian(Vec3f wi, Vec3f m) { return 1 / (4 * std::abs(dot(wi, m))); }
float refractionJacobian(Vec3f wo, Vec3f wi, Vec3f m, float eta) {
  const float d = dot(wo, m) + eta * dot(wi, m);
  return eta * eta * std::abs(dot(wi, m)) / std::max(d * d, 1e-20f);
}

// Micro-normal that refracts wo into wi, in the upper hemisphere.
Vec3f refractionNormal(Vec3f wo, Vec3f wi, float eta) {
  const Vec3f h = wo + wi * eta;
  const float length2 = lengthSquared(h);
  if (!(length2 > 1e-20f)) return {0, 0, 0};  // index-matched, straight through
  const Vec3f m = h / std::sqrt(length2);
  return m.z < 0 ? -m : m;
}

float microfacetReflectionPdf(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  if (wi.z <= 0) return 0;
  const Vec3f m = normalize(wo + wi);
  if (dot(wo, m) <= 0) return 0;
  return microNormalPdf(lobe.distribution, lobe.alphaX, lobe.alphaY, wo, m) *
         reflectionJacobian(wi, m);
}

float microfacetTransmissionPdf(const Lobe& lobe, Vec3f wo, Vec3f wi, float eta) {
  if (wi.z >= 0) return 0;
  const Vec3f m = refractionNormal(wo, wi, eta);
  if (dot(wo, m) <= 0 || dot(wi, m) >= 0) return 0;
  return microNormalPdf(lobe.distribution, lobe.alphaX, lobe.alphaY, wo, m) *
         refractionJacobian(wo, wi, m, eta);
}

// Ward's exponential has the shape of the Beckmann distribution.
Vec3f sampleWardNormal(const Lobe& lobe, Vec2f u) {
  const float phi =
      std::atan2(lobe.alphaY * std::sin(kTwoPi * u.x), lobe.alphaX * std::cos(kTwoPi * u.x));
  const float c = std::cos(phi), s = std::sin(phi);
  const float tan2 = -std::log1p(-u.y) / (sqr(c / lobe.alphaX) + sqr(s / lobe.alphaY));
  const float cosTheta = 1 / std::sqrt(1 + tan2);
  const float sinTheta = std::sqrt(tan2) * cosTheta;
  return {c * sinTheta, s * sinTheta, cosTheta};
}

float wardPdf(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  if (wi.z <= 0) return 0;
  const Vec3f m = normalize(wo + wi);
  const float d = dot(wo, m);
  if (d <= 0 || m.z <= 0) return 0;
  return core::microfacetDensity(Distribution::beckmann, lobe.alphaX, lobe.alphaY, toCore(m)) *
         m.z / (4 * d);
}

Vec3f samplePhongLobe(const Lobe& lobe, Vec3f wo, Vec2f u) {
  const float logCos = std::log(1 - u.y) / (lobe.alphaX + 1);
  const float sinTheta = std::sqrt(std::max(0.f, -std::expm1(2 * logCos)));
  const float phi = kTwoPi * u.x;
  const Frame frame = frameFromNormal(Vec3f(-wo.x, -wo.y, wo.z));
  return frame.toWorld(Vec3f(std::cos(phi) * sinTheta, std::sin(phi) * sinTheta, std::exp(logCos)));
}

float phongPdf(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const float c = wo.z * wi.z - wo.x * wi.x - wo.y * wi.y;
  if (wi.z <= 0 || c <= 0) return 0;
  return (lobe.alphaX + 1) * (0.5f * kInvPi) * std::pow(c, lobe.alphaX);
}

// Probability of refracting at a micro-normal of a rough interface.
float refractionChance(const Lobe& reflection, const Lobe& transmission, float cosine,
                       bool behind) {
  const float eta = behind ? 1 / reflection.eta.x : reflection.eta.x;
  const float t = 1 - core::fresnelDielectric(cosine, eta);
  return behind ? t : t * std::clamp(transmission.parameters.z, 0.f, 1.f);
}

}  // namespace

Vec3f reflect(Vec3f w, Vec3f m) { return m * (2 * dot(w, m)) - w; }

std::optional<Vec3f> refract(Vec3f w, Vec3f m, float eta) {
  const float c = dot(w, m);
  const float cos2 = 1 - (1 - c * c) / (eta * eta);
  if (!(cos2 > 0)) return std::nullopt;
  return m * (c / eta - std::sqrt(cos2)) - w / eta;
}

std::optional<Vec3f> sampleLobe(const Lobe& lobe, Vec3f woGiven, Vec2f u) {
  const bool behind = woGiven.z < 0;
  const Vec3f wo = behind ? flipZ(woGiven) : woGiven;
  Vec3f wi;
  bool through = false;
  switch (lobe.type) {
    case LobeType::lambert:
    case LobeType::coatedDiffuse:
    case LobeType::principledDiffuse:
      wi = sampleHemisphereCosine(u);
      break;
    case LobeType::diffuseTransmission:
      wi = flipZ(sampleHemisphereCosine(u));
      through = true;
      break;
    case LobeType::sheen:
      // Flat or towards the horizon: the cosine would miss the most of it [Estevez17, section 4].
      wi = {std::cos(kTwoPi * u.x) * std::sqrt(u.y * (2 - u.y)),
            std::sin(kTwoPi * u.x) * std::sqrt(u.y * (2 - u.y)), 1 - u.y};
      break;
    case LobeType::microfacetReflection:
    case LobeType::thinTransmission: {
      const Vec3f m = sampleMicroNormal(lobe.distribution, lobe.alphaX, lobe.alphaY, wo, u);
      if (dot(wo, m) <= 0) return std::nullopt;
      wi = reflect(wo, m);
      through = lobe.type == LobeType::thinTransmission;
      if (through) wi = flipZ(wi);
      break;
    }
    case LobeType::microfacetTransmission: {
      const Vec3f m = sampleMicroNormal(lobe.distribution, lobe.alphaX, lobe.alphaY, wo, u);
      if (dot(wo, m) <= 0) return std::nullopt;
      const auto refracted = refract(wo, m, relativeEta(lobe, behind));
      if (!refracted) return std::nullopt;
      wi = *refracted;
      through = true;
      break;
    }
    case LobeType::phong:
      wi = samplePhongLobe(lobe, wo, u);
      break;
    case LobeType::ward: {
      const Vec3f m = sampleWardNormal(lobe, u);
      if (dot(wo, m) <= 0) return std::nullopt;
      wi = reflect(wo, m);
      break;
    }
    case LobeType::deltaReflection:
    case LobeType::deltaTransmission:
    case LobeType::null:
      return std::nullopt;
  }
  if (through ? wi.z >= 0 : wi.z <= 0) return std::nullopt;
  wi = normalize(wi);
  return behind ? flipZ(wi) : wi;
}

float lobePdf(const Lobe& lobe, Vec3f woGiven, Vec3f wiGiven) {
  const bool behind = woGiven.z < 0;
  const Vec3f wo = behind ? flipZ(woGiven) : woGiven;
  const Vec3f wi = behind ? flipZ(wiGiven) : wiGiven;
  switch (lobe.type) {
    case LobeType::lambert:
    case LobeType::coatedDiffuse:
    case LobeType::principledDiffuse:
      return std::max(wi.z, 0.f) * kInvPi;
    case LobeType::diffuseTransmission:
      return std::max(-wi.z, 0.f) * kInvPi;
    case LobeType::sheen:
      return wi.z > 0 ? 0.5f * kInvPi : 0.f;
    case LobeType::microfacetReflection:
      return microfacetReflectionPdf(lobe, wo, wi);
    case LobeType::thinTransmission:
      return microfacetReflectionPdf(lobe, wo, flipZ(wi));
    case LobeType::microfacetTransmission:
      return microfacetTransmissionPdf(lobe, wo, wi, relativeEta(lobe, behind));
    case LobeType::phong:
      return phongPdf(lobe, wo, wi);
    case LobeType::ward:
      return wardPdf(lobe, wo, wi);
    case LobeType::deltaReflection:
    case LobeType::deltaTransmission:
    case LobeType::null:
      break;
  }
  return 0;
}

namespace {

// GGX samples the normals that wo sees, whose density is the greater part of the value.
LobeValue ggxReflection(const Lobe& lobe, Vec3f wo, Vec3f wi, bool behind) {
  const Vec3f m = normalize(wo + wi);
  const float cosine = dot(wo, m);
  if (!(wi.z > 0) || !(cosine > 0)) return {};
  const auto masking = [&](Vec3f w) {
    return core::smithMasking(Distribution::ggx, lobe.alphaX, lobe.alphaY, toCore(w));
  };
  const float pdf =
      core::microfacetDensity(Distribution::ggx, lobe.alphaX, lobe.alphaY, toCore(m)) *
      masking(wo) / (4 * wo.z);
  return {lobe.weight * fresnelOf(lobe, cosine, behind && lobe.interface) * (pdf * masking(wi)),
          pdf};
}

}  // namespace

LobeValue evaluateWithPdf(const Lobe& lobe, Vec3f wo, Vec3f wi) {
  const bool plain = lobe.type == LobeType::microfacetReflection &&
                     lobe.distribution == Distribution::ggx &&
                     lobe.fresnel != Fresnel::principled && !isCoated(lobe);
  if (!plain) return {evaluateLobe(lobe, wo, wi), lobePdf(lobe, wo, wi)};
  if (!isActive(lobe, wo.z)) return {};
  const bool behind = wo.z < 0;
  return behind ? ggxReflection(lobe, flipZ(wo), flipZ(wi), true)
                : ggxReflection(lobe, wo, wi, false);
}

std::optional<Vec3f> sampleInterface(const Lobe& reflection, const Lobe& transmission, Vec3f wo,
                                     float u1, Vec2f u) {
  const bool behind = wo.z < 0;
  const Vec3f w = behind ? flipZ(wo) : wo;
  const Vec3f m =
      sampleMicroNormal(reflection.distribution, reflection.alphaX, reflection.alphaY, w, u);
  const float cosine = dot(w, m);
  if (cosine <= 0) return std::nullopt;
  Vec3f wi;
  if (u1 < refractionChance(reflection, transmission, cosine, behind)) {
    const auto refracted = refract(w, m, relativeEta(transmission, behind));
    if (!refracted || refracted->z >= 0) return std::nullopt;
    wi = normalize(*refracted);
  } else {
    wi = normalize(reflect(w, m));
    if (wi.z <= 0) return std::nullopt;
  }
  return behind ? flipZ(wi) : wi;
}

float interfacePdf(const Lobe& reflection, const Lobe& transmission, Vec3f wo, Vec3f wi) {
  const bool behind = wo.z < 0;
  const Vec3f o = behind ? flipZ(wo) : wo, i = behind ? flipZ(wi) : wi;
  const bool through = i.z < 0;
  const float eta = relativeEta(transmission, behind);
  const Vec3f m = through ? refractionNormal(o, i, eta) : normalize(o + i);
  const float cosine = dot(o, m);
  if (cosine <= 0) return 0;
  const float chance = refractionChance(reflection, transmission, cosine, behind);
  return through ? chance * microfacetTransmissionPdf(transmission, o, i, eta)
                 : (1 - chance) * microfacetReflectionPdf(reflection, o, i);
}

}  // namespace lobelia
