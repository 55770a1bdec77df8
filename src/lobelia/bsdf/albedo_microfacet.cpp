// The albedo is an average of the Fresnel factor F(c) over the cosine c between wo and the
// micro-normal, E = integral of F(c) p(c) with the energy in p. F is smooth in c, so that p is kept
// as an interpolatory quadrature on fixed Chebyshev nodes, weight_k = integral of L_k(c) p(c) (L_k:
// Lagrange polynomials): ten Fresnel values give the albedo of any conductor or dielectric. Only
// total internal reflection is not smooth: average() says what is done there; a few percent off.
// Refraction masks less than reflection: the transmittance is tabulated at one index and scaled to
// others by the ratio that the reflection's quadrature gives.
#include "lobelia/bsdf/albedo_microfacet.h"

#include <cmath>

#include "lobelia/bsdf/albedo_grid.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/microfacet_sampling.h"
#include "lobelia/bsdf/quadrature.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr int kNodes = 10;
constexpr int kNormals = 24;           // nodes per dimension of the micro-normals
constexpr float kReferenceEta = 1.5f;  // see microfacetTransmittance()
using Grid = AlbedoGrid<kNodes + 2>;   // transmittance at the reference index, from both sides

// Chebyshev nodes of the first kind in (0, 1) and their barycentric weights.
struct ChebyshevRule {
  std::array<double, kNodes> nodes, weights;
  ChebyshevRule() {
    for (int k = 0; k < kNodes; ++k) {
      const double angle = 3.14159265358979323846 * (2 * k + 1) / (2 * kNodes);
      nodes[static_cast<size_t>(k)] = 0.5 * (1 - std::cos(angle));
      weights[static_cast<size_t>(k)] = (k % 2 == 0 ? 1 : -1) * std::sin(angle);
    }
  }
  // Adds value * L_k(c) to sums[k].
  void scatter(double c, double value, std::array<double, kNodes>& sums) const {
    std::array<double, kNodes> terms;
    double total = 0;
    for (size_t k = 0; k < kNodes; ++k) {
      const double d = c - nodes[k];
      if (std::abs(d) < 1e-12) {
        sums[k] += value;
        return;
      }
      terms[k] = weights[k] / d;
      total += terms[k];
    }
    for (size_t k = 0; k < kNodes; ++k) sums[k] += value * terms[k] / total;
  }
};

// A micro-normal seen from wo and its weight without the masking of the other direction, in a
// quadrature over u and v (half of the azimuths; v about the plane of incidence).
struct WeightedNormal {
  Vec3f m;
  float weight = 0;
};
WeightedNormal normalAt(Distribution distribution, float alpha, Vec3f wo, float u, float v) {
  WeightedNormal n;
  if (distribution == Distribution::ggx) {
    // The spherical cap is symmetric to the plane of incidence for v in (0, 1/2).
    n.m = sampleMicroNormal(distribution, alpha, alpha, wo, {0.5f * v, u});
    n.weight = 1;
    return n;
  }
  float sin2 = 0;
  const float a2 = alpha * alpha;
  if (distribution == Distribution::beckmann) {
    const float t = -a2 * std::log1p(-u);
    sin2 = t / (1 + t);
  } else if (distribution == Distribution::phong) {
    sin2 = -std::expm1(std::log1p(-u) * std::min(a2, 1.f));
  } else if (distribution == Distribution::sphericalGaussian) {
    const float depth = -std::log1p(u * std::expm1(-2 / a2)) * 0.5f * a2;
    sin2 = depth * (2 - depth);
  } else {
    sin2 = (std::pow(a2, 1 - u) - a2) / (1 - a2);
  }
  const float s = std::sqrt(std::max(sin2, 0.f));
  n.m = {s * std::cos(kPi * v), s * std::sin(kPi * v), std::sqrt(std::max(1 - sin2, 1e-12f))};
  n.weight = core::smithMasking(distribution, alpha, alpha, toCore(wo)) * dot(wo, n.m) / n.m.z;
  if (distribution != Distribution::gtr1) n.weight /= wo.z;
  // Drawn from D, not from D cos.
  if (distribution == Distribution::sphericalGaussian)
    n.weight *= n.m.z * kTwoPi * core::expRatio(2 / a2) / core::sgProjectedIntegral(2 / a2);
  return n;
}

Grid makeGrid(Distribution distribution) {
  const ChebyshevRule chebyshev;
  const GaussRule rule = gaussLegendre(kNormals);
  const auto integrate = [&](float cosine, float alpha) {
    const Vec3f wo(std::sqrt(std::max(0.f, 1 - cosine * cosine)), 0, cosine);
    std::array<double, kNodes> sums{};
    double outward = 0, inward = 0;
    for (size_t r = 0; r < rule.nodes.size(); ++r) {
      for (size_t a = 0; a < rule.nodes.size(); ++a) {
        const auto normal = normalAt(distribution, alpha, wo, static_cast<float>(rule.nodes[r]),
                                     static_cast<float>(rule.nodes[a]));
        const Vec3f m = normal.m;
        const float weight = normal.weight;
        const float c = dot(wo, m);
        if (c <= 0) continue;
        const double share = rule.weights[r] * rule.weights[a] * static_cast<double>(weight);
        const auto masked = [&](Vec3f v) {
          return share *
                 static_cast<double>(core::smithMasking(distribution, alpha, alpha, toCore(v)));
        };
        const Vec3f wi = reflect(wo, m);
        if (wi.z > 0) {
          double value = masked(wi);
          if (distribution == Distribution::gtr1) value *= static_cast<double>(4 * wi.z);
          chebyshev.scatter(static_cast<double>(c), value, sums);
        }
        const auto transmitted = [&](float eta) {
          const auto wt = refract(wo, m, eta);
          return wt && wt->z < 0
                     ? masked(*wt) * static_cast<double>(1 - core::fresnelDielectric(c, eta))
                     : 0.0;
        };
        outward += transmitted(kReferenceEta);
        inward += transmitted(1 / kReferenceEta);
      }
    }
    Grid::Entry entry;
    for (size_t k = 0; k < kNodes; ++k) entry[k] = static_cast<float>(sums[k]);
    entry[kNodes] = static_cast<float>(outward);
    entry[kNodes + 1] = static_cast<float>(inward);
    return entry;
  };
  if (distribution == Distribution::gtr1) return {33, 12, 0.001f, 0.1f, integrate};
  // Exponents of the Phong distribution end at alpha 1.
  if (distribution == Distribution::phong) return {44, 25, 0.004f, 1.f, integrate};
  // Changes fastest where it is nearly flat: sharpness 1/2 is alpha 2.
  if (distribution == Distribution::sphericalGaussian) return {44, 32, 0.004f, 2.6f, integrate};
  return {44, 25, 0.004f, 2.f, integrate};
}

// Built on first use, one per distribution.
const Grid& gridOf(Distribution distribution) {
  switch (distribution) {
    case Distribution::beckmann: {
      static const Grid grid = makeGrid(Distribution::beckmann);
      return grid;
    }
    case Distribution::phong: {
      static const Grid grid = makeGrid(Distribution::phong);
      return grid;
    }
    case Distribution::gtr1: {
      static const Grid grid = makeGrid(Distribution::gtr1);
      return grid;
    }
    case Distribution::sphericalGaussian: {
      static const Grid grid = makeGrid(Distribution::sphericalGaussian);
      return grid;
    }
    case Distribution::ggx:
      break;
  }
  static const Grid grid = makeGrid(Distribution::ggx);
  return grid;
}

const ChebyshevRule& chebyshevRule() {
  static const ChebyshevRule rule;
  return rule;
}
// Anisotropic lobes: the roughness whose slopes have the same variance.
Grid::Entry entryOf(const Lobe& lobe, float cosine) {
  const float alpha = std::sqrt(0.5f * (sqr(lobe.alphaX) + sqr(lobe.alphaY)));
  return gridOf(lobe.distribution).lookUp(cosine, alpha);
}

// Average of f(cosine) over the cosines at the micro-normals, times the energy. f is smooth, or has
// the corner of total reflection: then p is taken as uniform with the table's mean and variance.
template <class F>
auto average(const Grid::Entry& entry, bool corner, const F& f) {
  decltype(f(0.f)) sum{};
  if (!corner) {
    for (size_t k = 0; k < kNodes; ++k)
      sum += f(static_cast<float>(chebyshevRule().nodes[k])) * entry[k];
    return sum;
  }
  double energy = 0, first = 0, second = 0;
  for (size_t k = 0; k < kNodes; ++k) {
    const double w = static_cast<double>(entry[k]), c = chebyshevRule().nodes[k];
    energy += w, first += w * c, second += w * c * c;
  }
  if (!(energy > 0)) return sum;
  const double mean = first / energy;
  const double half = std::sqrt(3 * std::max(second / energy - mean * mean, 0.0));
  constexpr int kSteps = 12;
  for (int i = 0; i < kSteps; ++i) {
    const double c = mean + half * ((2 * i + 1.0) / kSteps - 1);
    sum += f(static_cast<float>(std::clamp(c, 0.0, 1.0))) * static_cast<float>(energy / kSteps);
  }
  return sum;
}

float transmitted(const Grid::Entry& entry, float eta) {
  return average(entry, eta < 1, [&](float c) { return 1 - core::fresnelDielectric(c, eta); });
}

}  // namespace

Rgb microfacetReflectance(const Lobe& lobe, float cosine, bool behind) {
  const Grid::Entry entry = entryOf(lobe, cosine);
  if (lobe.fresnel == Fresnel::one)
    return max(Rgb(average(entry, false, [](float) { return 1.f; })), Rgb(0.f));
  const bool corner =
      (lobe.fresnel == Fresnel::dielectric || lobe.fresnel == Fresnel::principled) &&
      relativeEta(lobe, behind) < 1;
  return max(average(entry, corner, [&](float c) { return fresnelOf(lobe, c, behind); }), Rgb(0.f));
}

float microfacetTransmittance(const Lobe& lobe, float cosine, bool behind) {
  const Grid::Entry entry = entryOf(lobe, cosine);
  const float estimate = transmitted(entry, relativeEta(lobe, behind));
  // What the estimate leaves out: refraction masks otherwise than reflection.
  const float atReference = transmitted(entry, behind ? 1 / kReferenceEta : kReferenceEta);
  float ratio = 1;
  if (atReference > 0.1f)
    ratio = std::clamp(entry[kNodes + (behind ? 1 : 0)] / atReference, 0.7f, 1.4f);
  return std::clamp(estimate * ratio, 0.f, 1.f);
}

}  // namespace lobelia
