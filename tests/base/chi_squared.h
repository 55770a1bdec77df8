// Pearson's chi-squared test, for the tests of samplers.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace lobelia::test {

// Regularised upper incomplete gamma function Q(a, x), by its series or continued fraction
// (Abramowitz and Stegun 6.5.29, 6.5.31).
inline double upperGamma(double a, double x) {
  if (x <= 0) return 1;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 100000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return 1 - sum * scale;
  }
  // Lentz's method.
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 100000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    const double delta = d * c;
    h *= delta;
    if (std::abs(delta - 1) < 1e-15) break;
  }
  return h * scale;
}

// Probability of counts at least this far from their expectations. Cells are pooled, in the order
// given, until at least five are expected. 0 when something fell where nothing is expected.
inline double chiSquaredPValue(std::span<const double> observed, std::span<const double> expected) {
  double statistic = 0, poolObserved = 0, poolExpected = 0;
  int cells = 0;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] <= 0 && observed[i] > 0) return 0;
    poolObserved += observed[i], poolExpected += expected[i];
    if (poolExpected < 5) continue;
    statistic += (poolObserved - poolExpected) * (poolObserved - poolExpected) / poolExpected;
    poolObserved = poolExpected = 0;
    ++cells;
  }
  if (cells < 2) return 1;
  return upperGamma(0.5 * (cells - 1), 0.5 * statistic);
}

}  // namespace lobelia::test
