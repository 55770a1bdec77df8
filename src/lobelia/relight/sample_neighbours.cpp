#include "lobelia/relight/sample_neighbours.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lobelia/relight/point_grid.h"

namespace lobelia::relight {

SampleNeighbours::SampleNeighbours(const LightSamples& samples) : begin_{0} {
  // Points as even as can be, a triangular lattice, are sqrt(2 / sqrt(3)) apart for a measure of 1
  // each; the next ring of them is sqrt(3) times as far.
  const float radius =
      PointGrid::uncrowded(samples.p, 1.4f * 1.0746f * std::sqrt(samples.measure.front()));
  const PointGrid grid(samples.p, radius);
  std::vector<std::pair<float, uint32_t>> near;  // squared distance, sample
  for (size_t i = 0; i < samples.count(); ++i) {
    near.clear();
    grid.near(samples.p[i], [&](uint32_t j) {
      if (j != i && (samples.n.empty() || dot(samples.n[i], samples.n[j]) > 0))
        near.emplace_back(lengthSquared(samples.p[i] - samples.p[j]), j);
    });
    if (near.size() > kMost) {
      std::nth_element(near.begin(), near.begin() + kMost, near.end());
      near.resize(kMost);
      std::sort(near.begin(), near.end());
    }
    for (const auto& [distance, j] : near) others_.push_back(static_cast<uint16_t>(j));
    begin_.push_back(static_cast<uint32_t>(others_.size()));
  }
}

}  // namespace lobelia::relight
