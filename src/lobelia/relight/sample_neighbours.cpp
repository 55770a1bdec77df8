#include "lobelia/relight/sample_neighbours.h"

#include <cmath>

#include "lobelia/relight/point_grid.h"

namespace lobelia::relight {

SampleNeighbours::SampleNeighbours(const LightSamples& samples) : begin_{0} {
  // Points as even as can be, a triangular lattice, are sqrt(2 / sqrt(3)) apart for a measure of 1
  // each; the next ring of them is sqrt(3) times as far.
  const float radius = 1.4f * 1.0746f * std::sqrt(samples.measure.front());
  const PointGrid grid(samples.p, radius);
  for (size_t i = 0; i < samples.count(); ++i) {
    grid.near(samples.p[i], [&](uint32_t j) {
      if (j != i && (samples.n.empty() || dot(samples.n[i], samples.n[j]) > 0))
        others_.push_back(static_cast<uint16_t>(j));
    });
    begin_.push_back(static_cast<uint32_t>(others_.size()));
  }
}

}  // namespace lobelia::relight
