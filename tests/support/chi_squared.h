// Integrals over the sphere and Pearson's chi-squared test of samplers of directions against their
// densities.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "base/chi_squared.h"
#include "lobelia/base/frame.h"
#include "lobelia/base/random.h"

namespace lobelia::test {

// Directions in polar coordinates about an axis, rings logarithmic in 1 - cos from `spread` squared
// on: a lobe of that width (radians) about the axis spans many rings. x, y in [0, 1].
struct SphereChart {
  Frame frame;
  double scale;  // rings: 1 - cos = 2 expm1(scale x) / expm1(scale)
  SphereChart(Vec3f axis, double spread)
      : frame(frameFromNormal(axis)), scale(std::log(2 / std::min(spread * spread, 0.5)) + 1) {}
  Vec3f direction(double x, double y) const {
    const double oneMinusCos = 2 * std::expm1(scale * x) / std::expm1(scale);
    const double sine = std::sqrt(std::max(0.0, oneMinusCos * (2 - oneMinusCos)));
    const double phi = 2 * 3.14159265358979323846 * y;
    return frame.toWorld(Vec3f(static_cast<float>(sine * std::cos(phi)),
                               static_cast<float>(sine * std::sin(phi)),
                               static_cast<float>(1 - oneMinusCos)));
  }
  // Solid angle per dx dy.
  double jacobian(double x) const {
    return 2 * 3.14159265358979323846 * 2 * scale * std::exp(scale * x) / std::expm1(scale);
  }
  Vec2f coordinates(Vec3f w) const {
    const Vec3f l = frame.toLocal(w);
    const double sine2 = static_cast<double>(l.x) * static_cast<double>(l.x) +
                         static_cast<double>(l.y) * static_cast<double>(l.y);
    const double c = static_cast<double>(l.z);
    const double oneMinusCos = c > 0 ? sine2 / (1 + std::sqrt(std::max(0.0, 1 - sine2))) : 1 - c;
    const double x = std::log1p(oneMinusCos / 2 * std::expm1(scale)) / scale;
    double y = std::atan2(static_cast<double>(l.y), static_cast<double>(l.x)) /
               (2 * 3.14159265358979323846);
    if (y < 0) y += 1;
    return {static_cast<float>(x), static_cast<float>(y)};
  }
};

// Values per evaluation: one density, or the channels of a colour.
template <size_t N>
using Values = std::array<double, N>;

// Adaptive Gauss-Legendre integral of f over a cell of the chart, f(direction) -> Values<N>.
template <size_t N, class F>
Values<N> integrateCell(const SphereChart& chart, const F& f, double x0, double x1, double y0,
                        double y1, double tolerance, int depth) {
  static constexpr double kNode[5] = {0.04691007703066800, 0.23076534494715845, 0.5,
                                      0.76923465505284155, 0.95308992296933200};
  static constexpr double kWeight[5] = {0.11846344252809454, 0.23931433524968324,
                                        0.28444444444444444, 0.23931433524968324,
                                        0.11846344252809454};
  const auto rule = [&](double a0, double a1, double b0, double b1) {
    Values<N> sum{};
    for (int i = 0; i < 5; ++i) {
      const double x = a0 + (a1 - a0) * kNode[i];
      const double scale = chart.jacobian(x) * (a1 - a0) * (b1 - b0) * kWeight[i];
      for (int j = 0; j < 5; ++j) {
        const Values<N> v = f(chart.direction(x, b0 + (b1 - b0) * kNode[j]));
        for (size_t k = 0; k < N; ++k) sum[k] += scale * kWeight[j] * v[k];
      }
    }
    return sum;
  };
  const std::function<Values<N>(double, double, double, double, Values<N>, int)> refine =
      [&](double a0, double a1, double b0, double b1, Values<N> coarse, int left) {
        const double am = 0.5 * (a0 + a1), bm = 0.5 * (b0 + b1);
        const std::array<Values<N>, 4> parts{rule(a0, am, b0, bm), rule(am, a1, b0, bm),
                                             rule(a0, am, bm, b1), rule(am, a1, bm, b1)};
        Values<N> sum{};
        double error = 0;
        for (size_t k = 0; k < N; ++k) {
          for (const Values<N>& p : parts) sum[k] += p[k];
          error = std::max(error, std::abs(sum[k] - coarse[k]));
        }
        if (error < tolerance || left <= 0) return sum;
        sum = {};
        const double bounds[4][4] = {
            {a0, am, b0, bm}, {am, a1, b0, bm}, {a0, am, bm, b1}, {am, a1, bm, b1}};
        for (size_t p = 0; p < 4; ++p) {
          const Values<N> v =
              refine(bounds[p][0], bounds[p][1], bounds[p][2], bounds[p][3], parts[p], left - 1);
          for (size_t k = 0; k < N; ++k) sum[k] += v[k];
        }
        return sum;
      };
  return refine(x0, x1, y0, y1, rule(x0, x1, y0, y1), depth);
}

// Integral over the whole sphere, f(direction) -> Values<N>.
template <size_t N, class F>
Values<N> integrateSphere(const SphereChart& chart, const F& f, double tolerance = 2e-6) {
  constexpr int kRings = 12, kSectors = 12;
  Values<N> sum{};
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const Values<N> v =
          integrateCell<N>(chart, f, double(i) / kRings, double(i + 1) / kRings,
                           double(j) / kSectors, double(j + 1) / kSectors, tolerance, 7);
      for (size_t k = 0; k < N; ++k) sum[k] += v[k];
    }
  }
  return sum;
}

// Probability of a deviation like the observed one if the sampler follows its density. sample(rng)
// gives a direction, or nothing for a lost sample, whose expectation is what the density lacks to
// one.
template <class Sample, class Pdf>
double chiSquaredDirections(const SphereChart& chart, const Sample& sample, const Pdf& pdf,
                            uint64_t seed, int sampleCount = 60000) {
  constexpr int kRings = 16, kSectors = 16;
  std::vector<double> observed(kRings * kSectors + 1), expected(kRings * kSectors + 1);
  Rng rng(seed);
  for (int n = 0; n < sampleCount; ++n) {
    const std::optional<Vec3f> w = sample(rng);
    if (!w) {
      ++observed.back();
      continue;
    }
    const Vec2f c = chart.coordinates(*w);
    const int i = std::clamp(static_cast<int>(c.x * kRings), 0, kRings - 1);
    const int j = std::clamp(static_cast<int>(c.y * kSectors), 0, kSectors - 1);
    ++observed[static_cast<size_t>(i * kSectors + j)];
  }
  double total = 0;
  const auto density = [&](Vec3f w) { return Values<1>{static_cast<double>(pdf(w))}; };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const double mass =
          integrateCell<1>(chart, density, double(i) / kRings, double(i + 1) / kRings,
                           double(j) / kSectors, double(j + 1) / kSectors, 1e-6, 7)[0];
      expected[static_cast<size_t>(i * kSectors + j)] = mass * sampleCount;
      total += mass;
    }
  }
  // A density that integrates to more than one is wrong, whatever the counts are.
  if (total > 1 + 2e-3) return 0;
  // Lost samples first: cells are pooled in order, and the last pool may be dropped.
  expected.back() = std::max(0.0, 1 - total) * sampleCount;
  if (expected.back() < 5 && observed.back() > 30) return 0;
  std::rotate(observed.begin(), observed.end() - 1, observed.end());
  std::rotate(expected.begin(), expected.end() - 1, expected.end());
  expected.front() = std::max(expected.front(), 1e-9);
  // Rounding at the horizon may put a sample into a cell without mass.
  for (double& e : expected) e = std::max(e, 1e-9);
  return chiSquaredPValue(observed, expected);
}

// Significance of each of `tests` tests so that all together have `significance` (Sidak 1967).
inline double sidak(double significance, int tests) {
  return -std::expm1(std::log1p(-significance) / tests);
}

}  // namespace lobelia::test
