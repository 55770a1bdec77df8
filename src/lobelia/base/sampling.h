// Warps from the unit square to the usual domains. Densities are per solid angle or area as named.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "lobelia/base/prefetch.h"
#include "lobelia/base/random.h"
#include "lobelia/base/vec.h"

namespace lobelia {

// Unit disk (Shirley and Chiu 1997): squares around the centre become circles; the angle is
// proportional to the way along the side. Of angles within pi/4 the series are exact to rounding.
inline Vec2f sampleDiskConcentric(Vec2f u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1;
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y, other = wide ? y : x;
  if (r == 0) return {0, 0};
  const float a = (kPi / 4) * (other / r), a2 = a * a;
  const float c =
      1 - a2 * (1.f / 2 - a2 * (1.f / 24 - a2 * (1.f / 720 - a2 * (1.f / 40320 - a2 / 3628800))));
  const float s =
      a * (1 - a2 * (1.f / 6 - a2 * (1.f / 120 - a2 * (1.f / 5040 - a2 * (1.f / 362880)))));
  return wide ? Vec2f{r * c, r * s} : Vec2f{r * s, r * c};
}
// z >= 0, pdf cos/pi
inline Vec3f sampleHemisphereCosine(Vec2f u) {
  const Vec2f d = sampleDiskConcentric(u);
  return {d.x, d.y, std::sqrt(std::max(0.f, 1 - d.x * d.x - d.y * d.y))};
}
Vec3f sampleSphereUniform(Vec2f u);                      // pdf 1/(4 pi)
Vec3f sampleConeUniform(Vec2f u, float oneMinusCosMax);  // around +z, pdf 1/(2 pi (1-cosMax))
// barycentrics (b1, b2)
inline Vec2f sampleTriangleUniform(Vec2f u) {
  const float s = std::sqrt(u.x);
  return {1 - s, u.y * s};
}
inline float powerHeuristic(float pdfA, float pdfB) {
  // Divides first: squares of densities of sharp lobes overflow.
  if (pdfA <= 0) return 0;
  const float r = pdfB / pdfA;
  return 1 / (1 + r * r);
}

// Discrete distribution over n items in proportion to weights (>= 0). O(1) sampling by the alias
// method (Vose 1991). All-zero weights give an empty distribution (total() == 0).
class AliasTable {
 public:
  AliasTable() = default;
  explicit AliasTable(std::span<const float> weights);
  // Index for u in [0,1); `remapped` receives a fresh uniform number.
  size_t sample(float u, float* remapped = nullptr) const;
  // Asks memory for what sample(u) will read.
  void prefetch(float u) const {
    if (!bins_.empty()) prefetchRead(&bins_[binOf(u)]);
  }
  float probability(size_t i) const {
    return total_ > 0 ? static_cast<float>(weights_[i] / total_) : 0.f;
  }
  double total() const { return total_; }
  size_t size() const { return weights_.size(); }

 private:
  struct Bin {
    float q;
    uint32_t alias;
  };
  size_t binOf(float u) const {  // but for the bits below u's
    const auto i = static_cast<size_t>(static_cast<double>(u) * static_cast<double>(bins_.size()));
    return std::min(i, bins_.size() - 1);
  }
  std::vector<Bin> bins_;
  std::vector<float> weights_;
  double total_ = 0;
};

inline size_t AliasTable::sample(float u, float* remapped) const {
  assert(!bins_.empty());
  // u has 24 bits. A million bins leave four of them for the choice inside a bin, which would
  // favour the light items; a hash of u gives the bits below, which leaves strata as they are.
  const uint64_t hashed = mixBits(static_cast<uint64_t>(u * 0x1p24f) + 1);
  const double below = static_cast<double>(hashed >> 40) * 0x1p-48;
  const double scaled = (static_cast<double>(u) + below) * static_cast<double>(bins_.size());
  const size_t i = std::min(static_cast<size_t>(scaled), bins_.size() - 1);
  const double v = std::min(scaled - static_cast<double>(i), 1.0);
  const Bin& bin = bins_[i];
  const double q = static_cast<double>(bin.q);
  const bool own = v < q;
  if (remapped) {
    const double fresh = own ? v / q : (v - q) / (1 - q);
    *remapped = std::min(static_cast<float>(fresh), 0x1.fffffep-1f);
  }
  return own ? i : bin.alias;
}

// Piecewise-constant density on [0,1)^2 over nx x ny cells (row-major, weights >= 0), sampled by
// inverting marginal and conditional cumulatives, so that stratified input stays stratified.
class Distribution2D {
 public:
  Distribution2D() = default;
  Distribution2D(std::span<const float> weights, int nx, int ny);
  // pdf: with respect to the unit square; null where it is not wanted (that spares a cache miss).
  Vec2f sample(Vec2f u, float* pdf) const;
  // Asks memory for what sample() will read for these numbers, without waiting for it one by one;
  // cells: receives the indices of the cells that it will find, row by row.
  void prefetch(std::span<const Vec2f> u, std::span<size_t> cells) const;
  float pdf(Vec2f p) const;
  double total() const { return total_; }  // sum of weights

 private:
  int nx_ = 0, ny_ = 0;
  std::vector<float> weights_;
  std::vector<float> conditional_;  // ny rows of nx+1 cumulatives, each with levels above it
  std::vector<float> marginal_;     // ny+1, likewise
  double total_ = 0;
};

}  // namespace lobelia
