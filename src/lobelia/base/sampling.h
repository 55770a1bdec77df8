// Warps from the unit square to the usual domains. Densities are per solid angle or area as named.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia {

Vec2f sampleDiskConcentric(Vec2f u);            // unit disk (Shirley and Chiu 1997)
Vec3f sampleHemisphereCosine(Vec2f u);          // z >= 0, pdf cos/pi
Vec3f sampleSphereUniform(Vec2f u);             // pdf 1/(4 pi)
Vec3f sampleConeUniform(Vec2f u, float oneMinusCosMax);  // around +z, pdf 1/(2 pi (1-cosMax))
Vec2f sampleTriangleUniform(Vec2f u);           // barycentrics (b1, b2)
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
  float probability(size_t i) const { return total_ > 0 ? static_cast<float>(weights_[i] / total_) : 0.f; }
  double total() const { return total_; }
  size_t size() const { return weights_.size(); }

 private:
  struct Bin { float q; uint32_t alias; };
  std::vector<Bin> bins_;
  std::vector<float> weights_;
  double total_ = 0;
};

// Piecewise-constant density on [0,1)^2 over nx x ny cells (row-major, weights >= 0), sampled by
// inverting marginal and conditional cumulatives, so that stratified input stays stratified.
class Distribution2D {
 public:
  Distribution2D() = default;
  Distribution2D(std::span<const float> weights, int nx, int ny);
  // pdf: with respect to the unit square; null where it is not wanted (that spares a cache miss).
  Vec2f sample(Vec2f u, float* pdf) const;
  float pdf(Vec2f p) const;
  double total() const { return total_; }   // sum of weights

 private:
  int nx_ = 0, ny_ = 0;
  std::vector<float> weights_;
  std::vector<float> conditional_;  // ny rows of nx+1 cumulatives, each with levels above it
  std::vector<float> marginal_;     // ny+1, likewise
  double total_ = 0;
};

}  // namespace lobelia
