#include "lobelia/bsdf/nonnegative_least_squares.h"

#include <algorithm>
#include <cmath>

namespace lobelia {
namespace {

// Solves A x = b restricted to the unknowns that are free, by Cholesky factors; those that add
// nothing to the ones before them get zero.
Vector8 solveFree(const Matrix8& a, const Vector8& b, int n, const std::array<bool, 8>& isFree) {
  std::array<int, kMaxUnknowns> at{};
  int count = 0;
  for (int i = 0; i < n; ++i) {
    if (isFree[static_cast<size_t>(i)]) at[static_cast<size_t>(count++)] = i;
  }
  const auto index = [&](int i) { return static_cast<size_t>(at[static_cast<size_t>(i)]); };
  Matrix8 l{};
  Vector8 y{}, x{};
  for (int i = 0; i < count; ++i) {
    const auto r = static_cast<size_t>(i);
    for (int j = 0; j <= i; ++j) {
      const auto c = static_cast<size_t>(j);
      double sum = a[index(i)][index(j)];
      for (size_t k = 0; k < c; ++k) sum -= l[r][k] * l[c][k];
      if (i == j) {
        const bool depends = !(sum > 1e-11 * a[index(i)][index(i)]);
        l[r][r] = depends ? 0 : std::sqrt(sum);
      } else {
        l[r][c] = l[c][c] > 0 ? sum / l[c][c] : 0;
      }
    }
    double sum = b[index(i)];
    for (size_t k = 0; k < r; ++k) sum -= l[r][k] * y[k];
    y[r] = l[r][r] > 0 ? sum / l[r][r] : 0;
  }
  for (int i = count - 1; i >= 0; --i) {
    const auto r = static_cast<size_t>(i);
    double sum = y[r];
    for (int k = i + 1; k < count; ++k) sum -= l[static_cast<size_t>(k)][r] * x[index(k)];
    x[index(i)] = l[r][r] > 0 ? sum / l[r][r] : 0;
  }
  return x;
}

}  // namespace

Vector8 solveNonnegative(const Matrix8& a, const Vector8& b, int n) {
  std::array<bool, 8> isFree{};
  Vector8 x{};
  // Each round frees one unknown; a bound that no problem of this size reaches.
  for (int round = 0; round < 4 * kMaxUnknowns; ++round) {
    // The unknown whose growth helps most, in units of its column.
    int best = -1;
    double steepest = 1e-10;
    for (int i = 0; i < n; ++i) {
      const auto r = static_cast<size_t>(i);
      if (isFree[r] || !(a[r][r] > 0)) continue;
      double slope = b[r];
      for (int k = 0; k < n; ++k) slope -= a[r][static_cast<size_t>(k)] * x[static_cast<size_t>(k)];
      slope /= std::max(std::abs(b[r]), 1e-300);
      if (slope > steepest) best = i, steepest = slope;
    }
    if (best < 0) break;
    isFree[static_cast<size_t>(best)] = true;
    for (int inner = 0; inner <= kMaxUnknowns; ++inner) {
      const Vector8 wanted = solveFree(a, b, n, isFree);
      double step = 1;
      for (int i = 0; i < n; ++i) {
        const auto r = static_cast<size_t>(i);
        if (isFree[r] && wanted[r] <= 0)
          step = std::min(step, x[r] / std::max(x[r] - wanted[r], 1e-300));
      }
      for (int i = 0; i < n; ++i) {
        const auto r = static_cast<size_t>(i);
        x[r] += step * (wanted[r] - x[r]);
        if (isFree[r] && wanted[r] <= 0 && x[r] <= 1e-14 * std::abs(wanted[r])) {
          isFree[r] = false;
          x[r] = 0;
        }
        x[r] = std::max(x[r], 0.0);
      }
      if (step >= 1) break;
    }
  }
  return x;
}

}  // namespace lobelia
