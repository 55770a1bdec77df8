// Which light samples lie next to each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/relight/light_samples.h"

namespace lobelia::relight {

class SampleNeighbours {
 public:
  static constexpr size_t kMost = 16;
  // About six for each sample, none where surfaces are far apart; of places those that face one
  // way. The nearest kMost where surfaces crowd.
  explicit SampleNeighbours(const LightSamples& samples);
  std::span<const uint16_t> at(size_t sample) const {
    return {others_.data() + begin_[sample], others_.data() + begin_[sample + 1]};
  }

 private:
  std::vector<uint16_t> others_;  // there are at most 2^15 samples
  std::vector<uint32_t> begin_;
};

}  // namespace lobelia::relight
