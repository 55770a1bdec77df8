// Discrete sampling by the alias method: M. D. Vose, "A linear algorithm for generating random
// numbers with a given distribution", IEEE Transactions on Software Engineering 17(9), 1991.
#include <cassert>
#include <cstdint>
#include <limits>

#include "lobelia/base/random.h"
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

size_t AliasTable::sample(float u, float* remapped) const {
  assert(!bins_.empty());
  // u has 24 bits. A million bins leave four of them for the choice inside a bin, which would
  // favour the light items; a hash of u gives the bits below, which leaves strata as they are.
  const uint64_t hashed = mixBits(static_cast<uint64_t>(static_cast<double>(u) * 0x1p24) + 1);
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

}  // namespace lobelia
