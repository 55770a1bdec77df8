// Microfacet distributions as sums of co-axial Gaussians (docs/lobes.md).
//
// The numbers minimise the L1 distance between D(h) G(w), h half-way to w, and the sum, over the
// hemisphere at normal incidence (Nelder-Mead on 2500 rings; the residual stands in each row). GGX
// has tails that no single Gaussian follows below alpha = 0.4; above, its second one goes to zero.
#include <cmath>

#include "lobelia/bsdf/gaussian_shape.h"

namespace lobelia {
namespace {

struct Row {
  float alpha;
  std::array<ShapeComponent, kMaxShapeComponents> parts;
};

constexpr std::array<Row, 10> kGgx{{
    {0.02f, {{{0.5549f, 0.7344f}, {0.4451f, 0.1122f}, {0, 1}}}},  // 0.116
    {0.05f, {{{0.5522f, 0.7376f}, {0.4478f, 0.1139f}, {0, 1}}}},  // 0.110
    {0.10f, {{{0.5466f, 0.7433f}, {0.4534f, 0.1191f}, {0, 1}}}},  // 0.090
    {0.15f, {{{0.5244f, 0.7724f}, {0.4756f, 0.1346f}, {0, 1}}}},  // 0.060
    {0.20f, {{{0.4651f, 0.8603f}, {0.5349f, 0.1722f}, {0, 1}}}},  // 0.034
    {0.30f, {{{0.2863f, 1.1840f}, {0.7137f, 0.2991f}, {0, 1}}}},  // 0.014
    {0.40f, {{{0.0946f, 1.8958f}, {0.9054f, 0.4807f}, {0, 1}}}},  // 0.025
    {0.50f, {{{0, 1.8958f}, {1, 0.6524f}, {0, 1}}}},              // 0.044
    {0.60f, {{{0, 1.8958f}, {1, 0.7523f}, {0, 1}}}},              // 0.073
    {1.00f, {{{0, 1.8958f}, {1, 1.3187f}, {0, 1}}}},              // 0.131
}};
constexpr std::array<Row, 5> kGtr1{{
    {0.001f, {{{0.3192f, 0.0335f}, {0.3400f, 0.0007f}, {0.3409f, 2e-5f}}}},    // 0.38
    {0.003f, {{{0.3063f, 0.0612f}, {0.3447f, 0.0022f}, {0.3490f, 7e-5f}}}},    // 0.27
    {0.010f, {{{0.2775f, 0.1276f}, {0.3520f, 0.0091f}, {0.3705f, 0.0006f}}}},  // 0.14
    {0.030f, {{{0.2202f, 0.2740f}, {0.3539f, 0.0371f}, {0.4259f, 0.0047f}}}},  // 0.054
    {0.100f, {{{0.0897f, 0.7862f}, {0.3013f, 0.2159f}, {0.6090f, 0.0448f}}}},  // 0.013
}};
constexpr std::array<Row, 5> kBeckmann{{
    {0.10f, {{{1, 0.5f}, {0, 1}, {0, 1}}}},     // 0.009
    {0.20f, {{{1, 0.5146f}, {0, 1}, {0, 1}}}},  // 0.036
    {0.40f, {{{1, 0.5355f}, {0, 1}, {0, 1}}}},  // 0.111
    {0.60f, {{{1, 0.4936f}, {0, 1}, {0, 1}}}},  // 0.152
    {1.00f, {{{1, 0.5255f}, {0, 1}, {0, 1}}}},  // 0.176
}};

// A Gaussian over the half vector is one over the reflected direction: at normal incidence
// cos(theta / 2) - 1 = -theta^2 / 8 + ..., so that its sharpness is a quarter.
constexpr std::array<Row, 2> kSphericalGaussian{{
    {0.1f, {{{1, 0.5f}, {0, 1}, {0, 1}}}},
    {1.f, {{{1, 0.5f}, {0, 1}, {0, 1}}}},
}};

// Linear between rows: shares as they are, widths in their logarithm.
ShapeComponents interpolate(std::span<const Row> rows, float alpha) {
  size_t i = 0;
  while (i + 2 < rows.size() && rows[i + 1].alpha < alpha) ++i;
  const Row &a = rows[i], &b = rows[i + 1];
  const float t = std::clamp(
      (std::log(alpha) - std::log(a.alpha)) / (std::log(b.alpha) - std::log(a.alpha)), 0.f, 1.f);
  ShapeComponents result;
  for (size_t k = 0; k < kMaxShapeComponents; ++k) {
    const float share = a.parts[k].share * (1 - t) + b.parts[k].share * t;
    if (!(share > 0)) continue;
    const float width =
        std::exp(std::log(a.parts[k].width) * (1 - t) + std::log(b.parts[k].width) * t);
    result.parts[static_cast<size_t>(result.count++)] = {share, width};
  }
  return result;
}

}  // namespace

ShapeComponents componentsOf(Distribution distribution, float alpha, int limit) {
  std::span<const Row> rows = kBeckmann;
  if (distribution == Distribution::ggx) rows = kGgx;
  if (distribution == Distribution::gtr1) rows = kGtr1;
  if (distribution == Distribution::sphericalGaussian) rows = kSphericalGaussian;
  ShapeComponents components = interpolate(rows, std::max(alpha, 1e-6f));
  if (components.count > limit) {
    components.count = 1;
    components.parts[0] = {1, 0.5f};
  }
  return components;
}

}  // namespace lobelia
