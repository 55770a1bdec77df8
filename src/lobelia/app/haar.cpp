#include "lobelia/app/haar.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <stdexcept>

namespace lobelia::app {

HaarTransform::HaarTransform(size_t side) : side_(side), scratch_(side * side) {
  if (!std::has_single_bit(side))
    throw std::invalid_argument("a Haar transform is of a power of two of pixels a side");
}

void HaarTransform::require(std::span<float> pixels) const {
  if (pixels.size() != side_ * side_)
    throw std::invalid_argument("a Haar transform of a picture of another size");
}

// Means of squares of four go to the upper left quarter, differences to the other three; then the
// quarter's turn.
void HaarTransform::forward(std::span<float> pixels) {
  require(pixels);
  for (size_t side = side_; side > 1; side /= 2) {
    const size_t half = side / 2;
    for (size_t y = 0; y < half; ++y)
      for (size_t x = 0; x < half; ++x) {
        const float* const upper = &pixels[2 * y * side_ + 2 * x];
        const float* const lower = upper + side_;
        const float a = upper[0], b = upper[1], c = lower[0], d = lower[1];
        scratch_[y * side_ + x] = (a + b + c + d) * 0.5f;
        scratch_[y * side_ + x + half] = (a - b + c - d) * 0.5f;
        scratch_[(y + half) * side_ + x] = (a + b - c - d) * 0.5f;
        scratch_[(y + half) * side_ + x + half] = (a - b - c + d) * 0.5f;
      }
    for (size_t y = 0; y < side; ++y) std::copy_n(&scratch_[y * side_], side, &pixels[y * side_]);
  }
}

void HaarTransform::inverse(std::span<float> coefficients) {
  require(coefficients);
  for (size_t side = 2; side <= side_; side *= 2) {
    const size_t half = side / 2;
    for (size_t y = 0; y < half; ++y)
      for (size_t x = 0; x < half; ++x) {
        const float mean = coefficients[y * side_ + x], across = coefficients[y * side_ + x + half],
                    down = coefficients[(y + half) * side_ + x],
                    both = coefficients[(y + half) * side_ + x + half];
        float* const upper = &scratch_[2 * y * side_ + 2 * x];
        float* const lower = upper + side_;
        upper[0] = (mean + across + down + both) * 0.5f;
        upper[1] = (mean - across + down - both) * 0.5f;
        lower[0] = (mean + across - down - both) * 0.5f;
        lower[1] = (mean - across - down + both) * 0.5f;
      }
    for (size_t y = 0; y < side; ++y)
      std::copy_n(&scratch_[y * side_], side, &coefficients[y * side_]);
  }
}

CoefficientCounts::CoefficientCounts(std::span<const float> coefficients) {
  for (const float c : coefficients)
    if (c != 0) left_.push_back(static_cast<double>(c) * static_cast<double>(c));
  std::sort(left_.begin(), left_.end(), std::greater<>());
  left_.push_back(0);
  for (size_t i = left_.size() - 1; i > 0; --i) left_[i - 1] += left_[i];
}

size_t CoefficientCounts::terms(double squaredError) const {
  const auto first = std::lower_bound(left_.begin(), left_.end(), squaredError, std::greater<>());
  return static_cast<size_t>(first - left_.begin());
}

double CoefficientCounts::squaredError(size_t terms) const {
  return left_[std::min(terms, left_.size() - 1)];
}

}  // namespace lobelia::app
