// Discrete sampling by the alias method: M. D. Vose, "A linear algorithm for generating random
// numbers with a given distribution", IEEE Transactions on Software Engineering 17(9), 1991.
#include <cassert>
#include <cstdint>
#include <limits>

#include "lobelia/base/sampling.h"

namespace lobelia {

AliasTable::AliasTable(std::span<const float> weights) : weights_(weights.begin(), weights.end()) {
  const size_t n = weights_.size();
  assert(n < std::numeric_limits<uint32_t>::max());
  for (float w : weights_) {
    assert(w >= 0 && std::isfinite(w));
    total_ += static_cast<double>(w);
  }
  if (!(total_ > 0)) return;
  bins_.resize(n);
  // Bins of mean height 1: each small item fills its bin up with a part of a large one.
  std::vector<double> height(n);
  std::vector<uint32_t> small, large;
  for (size_t i = 0; i < n; ++i) {
    height[i] = static_cast<double>(weights_[i]) / total_ * static_cast<double>(n);
    (height[i] < 1 ? small : large).push_back(static_cast<uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t s = small.back(), l = large.back();
    small.pop_back();
    bins_[s] = {static_cast<float>(height[s]), l};
    height[l] -= 1 - height[s];
    if (height[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  // What is left is full up to rounding errors. A zero weight stays out of reach: its alias is an
  // item with weight.
  for (uint32_t l : large) bins_[l] = {1, l};
  uint32_t positive = 0;
  while (!(weights_[positive] > 0)) ++positive;
  for (uint32_t s : small) bins_[s] = {weights_[s] > 0 ? 1.f : 0.f, weights_[s] > 0 ? s : positive};
}

}  // namespace lobelia
