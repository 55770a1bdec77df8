// A map of light points with coarser levels of its sums [P001 supplement, section 5].
#pragma once

#include <vector>

#include "lobelia/lights/cluster_sums.h"
#include "lobelia/lights/reflective_shadow_map.h"

namespace lobelia {

// Level 0 has a texel for each of the map's, the top has one; a texel of a level is the sum (not
// the mean, as of textures) of four of the level below. Sums between texels and levels are
// interpolated, of averages; beyond the border its texels go on.
class MapPyramid {
 public:
  // The map must outlive the pyramid and stay as it is.
  MapPyramid(const ReflectiveShadowMap& map, bool toksvig);

  const ReflectiveShadowMap& map() const { return map_; }
  int top() const { return static_cast<int>(levels_.size()); }
  double weight() const { return total_; }  // luminance of the map's power
  // Sums over a square of 2^level texels around a place of the unit square, 0 <= level <= top().
  ClusterSums kernel(Vec2f at, float level) const;
  double kernelWeight(Vec2f at, float level) const;

 private:
  static constexpr int kTaps = 8;
  struct Tap {
    int level;
    size_t texel;
    double factor;
  };
  int taps(Vec2f at, float level, Tap* taps) const;
  void addBilinear(Vec2f at, int level, double factor, Tap* taps, int* count) const;
  double weightOf(const Tap& tap) const;

  const ReflectiveShadowMap& map_;
  bool toksvig_;
  double total_ = 0;
  std::vector<std::vector<ClusterSums>> levels_;  // without level 0, which is made of the map
};

}  // namespace lobelia
