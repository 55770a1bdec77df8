// Few shadow rays for many Gaussian lights: a receiver sends so many, to lights chosen by what they
// would send it if they were seen, each with its share of the sum over what it was chosen by.
//
// The estimate is unbiased; its variance is that of visibility alone, for the unshadowed sum is
// known (cheaper estimates of what lights would send left spikes). Lights are chosen by stratified
// steps over the running sum: one that makes more than a step of it is always chosen.
#pragma once

#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"

namespace lobelia::gather {

struct ShadowScene {
  const Tracer& tracer;
  const VirtualLights& lights;
  const PreparedLights& prepared;  // prepareLights()
  const GatherSettings& settings;
};

class ShadowChoice {
 public:
  // seed: of this set's random numbers. The tile must outlive it.
  ShadowChoice(const ShadowScene& scene, const Tile& tile, uint64_t seed);

  // The light of Gaussian lights [first, end), by settings.shadowRays > 0 rays of each point.
  // Returns the number of rays.
  size_t add(size_t first, size_t end, TileSums* sums);

  int64_t visibilityNs = 0, shadeNs = 0;

 private:
  void prepareBlock(size_t first, size_t end);
  void estimate(size_t first, size_t end);
  void choose();
  double randomOf(Vec3f point) const;  // in [0,1), the same whatever tile the point is in
  bool keepChosen(const float* factors);
  void addScaled(size_t light, const float* factors, TileSums* sums) const;

  const ShadowScene& scene_;
  const Tile& tile_;
  const uint64_t seed_;
  const size_t width_;  // values of a light: points of all strips
  LightBlock block_;
  PairMasks pairs_;
  PairValues values_;
  // Luminance of a light at a point as if it were seen; then the factor of those chosen, else 0.
  AlignedFloats weights_;  // [light][strip][lane]
};

}  // namespace lobelia::gather
