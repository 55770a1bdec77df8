#include "lobelia/transfer/lobe_moments.h"

#include <cmath>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/quadrature.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia::transfer {
namespace {

// Hammersley's points: i / n and the bit-reversed i, both at the centres of their strata.
Vec2f latticePoint(uint32_t i, uint32_t count) {
  uint32_t reversed = 0;
  for (uint32_t bit = 1, to = count >> 1; to > 0; bit <<= 1, to >>= 1)
    if (i & bit) reversed |= to;
  const float n = static_cast<float>(count);
  return {(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(reversed) + 0.5f) / n};
}

// Calls add(w, weight, solidAngle) for the points of a glossy lobe.
template <class Add>
void forEachPoint(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, uint32_t count, const Add& add) {
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const Vec3f o = frame.toLocal(wo);
  if (!isActive(lobe, o.z)) return;
  for (uint32_t i = 0; i < count; ++i) {
    const auto local = sampleLobe(lobe, o, latticePoint(i, count));
    if (!local) continue;
    const LobeValue value = evaluateWithPdf(lobe, o, *local);
    if (!(value.pdf > 0) || !(maxComponent(value.value) > 0)) continue;
    const Vec3f w = frame.toWorld(*local);
    const float solidAngle = 1 / (static_cast<float>(count) * value.pdf);
    const Rgb weight = value.value * (solidAngle * throughBumps(bsdf, frame, w, local->z));
    if (isFinite(weight)) add(w, weight, solidAngle);
  }
}

// By Gauss' rule in the squared cosine and evenly spaced azimuths.
Rgb integratedAlbedo(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo) {
  static const GaussRule rule = gaussLegendre(16);
  constexpr int kAzimuths = 24;
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const Vec3f o = frame.toLocal(wo);
  const float side = o.z < 0 ? -1.f : 1.f;
  Rgb sum{};
  for (size_t a = 0; a < rule.nodes.size(); ++a) {
    const float c2 = static_cast<float>(rule.nodes[a]);
    const float c = std::sqrt(c2), s = std::sqrt(1 - c2);
    const float weight = kPi * static_cast<float>(rule.weights[a]) / (c * kAzimuths);
    for (int b = 0; b < kAzimuths; ++b) {
      const float phi = kTwoPi * (static_cast<float>(b) + 0.5f) / kAzimuths;
      const Vec3f i(s * std::cos(phi), s * std::sin(phi), c * side);
      const float through = throughBumps(bsdf, frame, frame.toWorld(i), i.z);
      sum += evaluateLobe(lobe, o, i) * (weight * through);
    }
  }
  return sum;
}

}  // namespace

void quadraturePoints(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, uint32_t count,
                      std::vector<LobePoint>* points) {
  forEachPoint(bsdf, lobe, wo, count, [&](Vec3f w, Rgb weight, float solidAngle) {
    points->push_back({w, weight, solidAngle});
  });
}

LobeMoments glossyMoments(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, uint32_t count) {
  // In doubles: the length of a sharp lobe's mean direction is one less a ten-thousandth.
  Vec3d albedo{}, first{};
  forEachPoint(bsdf, lobe, wo, count, [&](Vec3f w, Rgb weight, float) {
    const auto l = static_cast<double>(luminance(weight));
    for (int i = 0; i < 3; ++i) {
      albedo[i] += static_cast<double>(weight[i]);
      first[i] += static_cast<double>(w[i]) * l;
    }
  });
  const auto rounded = [](Vec3d v) {
    return Vec3f(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
  };
  return {rounded(albedo), rounded(first)};
}

MomentPair momentPair(const Bsdf& bsdf, const Lobe& lobe, const Lobe& other, Vec3f wo,
                      uint32_t count) {
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const Vec3f o = frame.toLocal(wo);
  MomentPair sum;
  for (uint32_t i = 0; i < count; ++i) {
    const auto local = sampleLobe(other, o, latticePoint(i, count));
    if (!local) continue;
    const LobeValue value = evaluateWithPdf(other, o, *local);
    if (!(value.pdf > 0) || !(maxComponent(value.value) > 0)) continue;
    const float solidAngle = 1 / (static_cast<float>(count) * value.pdf);
    const Vec3f w = frame.toWorld(*local);
    const Rgb weight = value.value * solidAngle;
    const Rgb own =
        evaluateLobe(lobe, o, *local) * (solidAngle * throughBumps(bsdf, frame, w, local->z));
    if (!isFinite(weight) || !isFinite(own)) continue;
    sum.other.add({weight, w * luminance(weight)});
    sum.own.add({own, w * luminance(own)});
  }
  return sum;
}

std::optional<Rgb> closedAlbedo(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo) {
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const float cosine = dot(wo, frame.n);
  const bool isotropic = lobe.type == LobeType::phong || lobe.alphaX == lobe.alphaY;
  if (!isotropic || frame.perturbed || isCoated(lobe) || (lobe.interface && cosine < 0))
    return std::nullopt;
  return lobeAlbedo(lobe, cosine);
}

Rgb diffuseAlbedo(const Bsdf& bsdf, Vec3f wo) {
  Rgb sum{};
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (!isDiffuse(lobe.type) || !isActive(lobe, dot(wo, bsdf.frameOf(lobe).n))) continue;
    const auto closed = closedAlbedo(bsdf, lobe, wo);
    sum += closed ? *closed : integratedAlbedo(bsdf, lobe, wo);
  }
  return sum;
}

}  // namespace lobelia::transfer
