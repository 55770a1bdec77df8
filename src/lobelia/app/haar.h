// Haar wavelets of square pictures: what visibility cuts are compared with [P004 figure 8].
//
// The non-standard transform in two dimensions: rows and columns are halved in turn, so that a
// coefficient belongs to a square. It is orthonormal: the squared error of leaving coefficients out
// is the sum of their squares, and the largest ones by magnitude are the best to keep. (Of basis
// functions that are not normalised, these are the largest by magnitude times the root of their
// area, the "area weighted" choice of [Ng et al. 2003].)
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lobelia::app {

// For one thread; keeps its memory from picture to picture.
class HaarTransform {
 public:
  // Pictures of side x side pixels. Throws std::invalid_argument unless side is a power of two.
  explicit HaarTransform(size_t side);
  // In place, row-major. Each step multiplies sums and differences of four by a half: of pictures
  // of zeros and ones with up to 2048 pixels a side, floats hold every coefficient exactly.
  void forward(std::span<float> pixels);
  void inverse(std::span<float> coefficients);

 private:
  void require(std::span<float> pixels) const;
  size_t side_;
  std::vector<float> scratch_;
};

// How many of a function's coefficients an error takes.
class CoefficientCounts {
 public:
  // Of orthonormal coefficients.
  explicit CoefficientCounts(std::span<const float> coefficients);
  // The fewest that leave a squared error of at most this.
  size_t terms(double squaredError) const;
  // What is left with so many; 0 beyond all that are not zero.
  double squaredError(size_t terms) const;

 private:
  std::vector<double> left_;  // squares of what is left with 0, 1, 2... of them; ends with 0
};

}  // namespace lobelia::app
