#include "lobelia/bsdf/albedo.h"

#include <cmath>

#include "lobelia/base/frame.h"
#include "lobelia/bsdf/albedo_grid.h"
#include "lobelia/bsdf/albedo_microfacet.h"
#include "lobelia/bsdf/albedo_principled.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/quadrature.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

using Grid = AlbedoGrid<1>;

// Mean of f(u, phi) over u in (0,1), phi in (0, pi). Dense in u, because Ward's lobe ends abruptly
// at the horizon.
template <class F>
Grid::Entry meanOverNormals(const F& f) {
  static const GaussRule radii = gaussLegendre(64), azimuths = gaussLegendre(40);
  double sum = 0;
  for (size_t a = 0; a < radii.nodes.size(); ++a)
    for (size_t b = 0; b < azimuths.nodes.size(); ++b)
      sum += radii.weights[a] * azimuths.weights[b] *
             static_cast<double>(f(static_cast<float>(radii.nodes[a]),
                                   kPi * static_cast<float>(azimuths.nodes[b])));
  return {static_cast<float>(sum)};
}

Vec3f woAt(float cosine) { return {std::sqrt(std::max(0.f, 1 - cosine * cosine)), 0, cosine}; }

// Over the roughness sqrt(2 / (n + 2)) in place of the exponent n.
Grid makePhongGrid() {
  return Grid(49, 28, 0.004f, 1.f, [](float cosine, float alpha) {
    const float n = std::max(2 / (alpha * alpha) - 2, 0.f);
    const Frame frame = frameFromNormal(woAt(cosine));  // the mirror direction up to symmetry
    return meanOverNormals([&](float u, float phi) {
      // Azimuths of the lobe are symmetric about the plane of incidence, y = 0.
      const float logCos = std::log1p(-u) / (n + 1);
      const float s = std::sqrt(-std::expm1(2 * logCos));
      const float z = s * std::cos(phi) * std::sqrt(std::max(0.f, 1 - cosine * cosine)) +
                      std::exp(logCos) * frame.n.z;
      return (n + 2) / (n + 1) * std::max(z, 0.f);
    });
  });
}

Grid makeWardGrid(int variant) {
  return Grid(44, 22, 0.004f, 2.f, [variant](float cosine, float alpha) {
    const Vec3f wo = woAt(cosine);
    return meanOverNormals([&](float u, float phi) {
      const float tan2 = -alpha * alpha * std::log1p(-u);
      const float z = 1 / std::sqrt(1 + tan2), s = std::sqrt(tan2) * z;
      const Vec3f m(s * std::cos(phi), s * std::sin(phi), z);
      const float d = dot(wo, m);
      if (d <= 0) return 0.f;
      const Vec3f wi = reflect(wo, m);
      if (wi.z <= 0) return 0.f;
      // Value over density, see evaluateWard() and wardPdf().
      if (variant == 0) return m.z * m.z * m.z * d * std::sqrt(wi.z / wo.z);
      if (variant == 1) return m.z * m.z * m.z * d / wo.z;
      return wi.z / (d * m.z);
    });
  });
}

float phongAlbedo(float exponent, float cosine) {
  static const Grid grid = makePhongGrid();
  return grid.lookUp(cosine, std::sqrt(2 / (exponent + 2)))[0];
}

float wardAlbedo(int variant, float alpha, float cosine) {
  if (variant == 0) {
    static const Grid grid = makeWardGrid(0);
    return grid.lookUp(cosine, alpha)[0];
  }
  if (variant == 1) {
    static const Grid grid = makeWardGrid(1);
    return grid.lookUp(cosine, alpha)[0];
  }
  static const Grid grid = makeWardGrid(2);
  return grid.lookUp(cosine, alpha)[0];
}

// Nodes of the outer cosine c = u^2: the lobe lies at the horizon where alpha is small.
Grid makeSheenGrid() {
  return Grid(44, 22, kMinSheenAlpha, 1.f, [](float cosine, float alpha) {
    static const GaussRule rule = gaussLegendre(48);
    Lobe lobe;
    lobe.type = LobeType::sheen;
    lobe.alphaX = alpha;
    const Vec3f wo = woAt(cosine);
    double sum = 0;
    for (size_t a = 0; a < rule.nodes.size(); ++a) {
      const float u = static_cast<float>(rule.nodes[a]), c = u * u;
      const float s = std::sqrt(std::max(0.f, 1 - c * c));
      for (size_t b = 0; b < rule.nodes.size(); ++b) {
        const float phi = kPi * static_cast<float>(rule.nodes[b]);
        const Rgb f = evaluateLobe(lobe, wo, {s * std::cos(phi), s * std::sin(phi), c});
        sum += rule.weights[a] * rule.weights[b] * static_cast<double>(2 * u * kTwoPi * f.x);
      }
    }
    return Grid::Entry{static_cast<float>(sum)};
  });
}

float sheenAlbedo(float alpha, float cosine) {
  static const Grid grid = makeSheenGrid();
  return std::max(grid.lookUp(cosine, alpha)[0], 0.f);
}

float coatAlbedo(const Lobe& lobe, float cosine) {
  if (lobe.variant == 1) return lookUpCoat(lobe.table, cosine) * lobe.table[kTransmittanceSize];
  static const GaussRule rule = gaussLegendre(12);
  float mean = 0;
  for (size_t i = 0; i < rule.nodes.size(); ++i) {
    const float c = static_cast<float>(rule.nodes[i]);
    mean +=
        static_cast<float>(rule.weights[i]) * 2 * c * (1 - core::fresnelDielectric(c, lobe.eta.x));
  }
  return (1 - core::fresnelDielectric(cosine, lobe.eta.x)) * mean;
}

}  // namespace

Rgb lobeAlbedo(const Lobe& lobe, float cosThetaO) {
  if (!isActive(lobe, cosThetaO)) return {};
  const float cosine = std::min(std::abs(cosThetaO), 1.f);
  const bool behind = cosThetaO < 0 && lobe.interface;
  if (isCoated(lobe)) {
    // As if all light left by the cosine that it came by (sheen: by the mean of the layers).
    Lobe bare = lobe;
    bare.variant = static_cast<uint8_t>(bare.variant & ~kCoated);
    const Rgb below = lobeAlbedo(bare, cosThetaO);
    if (behind && lobe.type == LobeType::microfacetReflection) return below;
    const float t = lookUpCoat(lobe.table, cosine);
    if (lobe.type == LobeType::microfacetTransmission) return below * t;
    if (lobe.fresnel == Fresnel::coatedConductor) {
      const Rgb f = fresnelOf(lobe, cosine, false);
      return below * (t * t) / max(Rgb(1.f) - f * (1 - t), Rgb(1e-4f));
    }
    return below * (t * (lobe.type == LobeType::sheen ? lobe.table[kTransmittanceSize] : t));
  }
  switch (lobe.type) {
    case LobeType::lambert:
    case LobeType::diffuseTransmission:
      return lobe.weight;
    case LobeType::coatedDiffuse:
      return lobe.weight * coatAlbedo(lobe, cosine);
    case LobeType::principledDiffuse:
      return principledDiffuseAlbedo(lobe, cosine);
    case LobeType::sheen:
      return lobe.weight * sheenAlbedo(lobe.alphaX, cosine);
    case LobeType::thinTransmission: {
      Lobe whole = lobe;
      whole.fresnel = Fresnel::one;
      return lobe.weight * max(microfacetReflectance(whole, cosine, false) -
                                   microfacetReflectance(lobe, cosine, false),
                               Rgb(0.f));
    }
    case LobeType::microfacetReflection:
      return lobe.weight * microfacetReflectance(lobe, cosine, behind);
    case LobeType::microfacetTransmission:
      return lobe.weight * microfacetTransmittance(lobe, cosine, behind);
    case LobeType::phong:
      return lobe.weight * phongAlbedo(lobe.alphaX, cosine);
    case LobeType::ward:
      return lobe.weight * wardAlbedo(lobe.variant, std::sqrt(lobe.alphaX * lobe.alphaY), cosine);
    case LobeType::deltaReflection:
      return lobe.weight * fresnelOf(lobe, cosine, behind);
    case LobeType::deltaTransmission:
      return lobe.weight * (1 - core::fresnelDielectric(cosine, relativeEta(lobe, behind)));
    case LobeType::null:
      return lobe.fresnel == Fresnel::one
                 ? lobe.weight
                 : lobe.weight * (Rgb(1.f) - fresnelOf(lobe, cosine, behind));
  }
  return {};
}

}  // namespace lobelia
