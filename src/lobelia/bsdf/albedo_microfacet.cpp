// The albedo is an average of the Fresnel factor F(c) over the cosine c between wo and the
// micro-normal, E = integral of F(c) p(c) with the energy in p. F is smooth in c, so that p is kept
// as an interpolatory quadrature on fixed Chebyshev nodes, weight_k = integral of L_k(c) p(c) (L_k:
// Lagrange polynomials): ten Fresnel values give the albedo of any conductor or dielectric. Only
// total internal reflection is not smooth; there the error reaches a few percent.
#include "lobelia/bsdf/albedo_microfacet.h"

#include <cmath>

#include "lobelia/bsdf/albedo_grid.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/quadrature.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr int kNodes = 10;
using Grid = AlbedoGrid<kNodes>;
constexpr int kRadii = 28, kAzimuths = 28;  // of the micro-normals

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

// Micro-normals of the whole distribution, equally probable in u (D cos).
Vec3f normalAt(Distribution distribution, float alpha, float u, float phi) {
  float sin2 = 0;
  const float a2 = alpha * alpha;
  switch (distribution) {
    case Distribution::ggx:
      sin2 = a2 * u / (1 - u + a2 * u);
      break;
    case Distribution::beckmann: {
      const float t = -a2 * std::log1p(-u);
      sin2 = t / (1 + t);
      break;
    }
    case Distribution::phong:
      sin2 = -std::expm1(std::log1p(-u) * std::min(a2, 1.f));
      break;
    case Distribution::gtr1:
      sin2 = (std::pow(a2, 1 - u) - a2) / (1 - a2);
      break;
  }
  const float s = std::sqrt(std::max(sin2, 0.f));
  return {s * std::cos(phi), s * std::sin(phi), std::sqrt(std::max(1 - sin2, 1e-12f))};
}

Grid makeGrid(Distribution distribution) {
  const ChebyshevRule chebyshev;
  const GaussRule radii = gaussLegendre(kRadii), azimuths = gaussLegendre(kAzimuths);
  const auto integrate = [&](float cosine, float alpha) {
    const Vec3f wo(std::sqrt(std::max(0.f, 1 - cosine * cosine)), 0, cosine);
    const auto masking = [&](Vec3f v) {
      return core::smithMasking(distribution, alpha, alpha, toCore(v));
    };
    const float maskingO = masking(wo);
    std::array<double, kNodes> sums{};
    for (size_t r = 0; r < kRadii; ++r) {
      for (size_t a = 0; a < kAzimuths; ++a) {
        const Vec3f m = normalAt(distribution, alpha, static_cast<float>(radii.nodes[r]),
                                 kPi * static_cast<float>(azimuths.nodes[a]));
        const float c = dot(wo, m);
        if (c <= 0) continue;
        const Vec3f wi = reflect(wo, m);
        if (wi.z <= 0) continue;
        float value = maskingO * masking(wi) * c / m.z;
        value *= distribution == Distribution::gtr1 ? 4 * wi.z : 1 / cosine;
        chebyshev.scatter(static_cast<double>(c),
                          radii.weights[r] * azimuths.weights[a] * static_cast<double>(value),
                          sums);
      }
    }
    Grid::Entry entry;
    for (size_t k = 0; k < kNodes; ++k) entry[k] = static_cast<float>(sums[k]);
    return entry;
  };
  if (distribution == Distribution::gtr1) return {33, 12, 0.001f, 0.1f, integrate};
  return {56, 28, 0.004f, 2.f, integrate};
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
    case Distribution::ggx:
      break;
  }
  static const Grid grid = makeGrid(Distribution::ggx);
  return grid;
}

}  // namespace

Rgb microfacetAlbedo(const Lobe& lobe, float cosine, bool behind, bool complement) {
  static const ChebyshevRule chebyshev;
  const Grid::Entry weights =
      gridOf(lobe.distribution).lookUp(cosine, std::sqrt(lobe.alphaX * lobe.alphaY));
  Rgb sum{};
  for (size_t k = 0; k < kNodes; ++k) {
    const float c = static_cast<float>(chebyshev.nodes[k]);
    Rgb f(1.f);
    if (lobe.fresnel != Fresnel::one) f = fresnelOf(lobe, c, behind);
    sum += (complement ? Rgb(1.f) - f : f) * weights[k];
  }
  return max(sum, Rgb(0.f));
}

}  // namespace lobelia
