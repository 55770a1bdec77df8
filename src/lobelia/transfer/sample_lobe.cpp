#include "lobelia/transfer/sample_lobe.h"

#include <algorithm>
#include <cmath>

namespace lobelia::transfer {

void SampleLobe::add(Rgb weight, Vec3f direction) {
  const float energy = luminance(weight);
  sum_ += weight;
  first_ += direction * energy;
  energy_ += energy, squares_ += energy * energy;
}

TransferLobe SampleLobe::lobe(float total, float single) const {
  if (empty()) return {};
  const float mean = length(first_) / energy_;
  if (!(mean > 0)) return {sum_ / total, {}};
  const float n = energy_ * energy_ / squares_;
  constexpr float kFewest = 1.5f;  // effective samples below which they tell no width
  const float length =
      n < kFewest ? single : std::sqrt(std::max((n * mean * mean - 1) / (n - 1), 0.f));
  return {sum_ / total, first_ * (length / (mean * energy_))};
}

}  // namespace lobelia::transfer
