// Virtual spherical Gaussian lights from maps by filtered importance sampling [P001 supplement,
// section 5, algorithm 1; Krivanek08] and by k-means.
#pragma once

#include "lobelia/lights/cluster_sums.h"
#include "lobelia/lights/map_pyramid.h"
#include "lobelia/lights/reflective_shadow_map.h"

namespace lobelia {

struct FilteredSampling {
  size_t count = 1024;  // lights
  double overlap = 1;   // K of algorithm 1: kernels hold this share of the power, over `count`
  // Level of a kernel: from the density at its centre (original), or such that the kernel holds
  // K / count of the power (bisection; the paper's).
  enum class Level : uint8_t { original, bisection };
  Level level = Level::bisection;
  bool toksvig = false;
  uint64_t seed = 0;
};
// Level of the kernel around a place that was drawn with this density (of the unit square).
float kernelLevel(const MapPyramid& map, Vec2f at, float density, const FilteredSampling& sampling);
// Lights of one map; none where it has no power. With `bisection` each has the same luminance of
// power, a share 1 / count of the map's.
std::vector<GaussianLight> filteredLights(const ReflectiveShadowMap& map,
                                          const FilteredSampling& sampling);

// k-means without iterations, as in the paper: centres are drawn by power, and every point belongs
// to the nearest in space and on the map. scale: size of the scene. mapWeight: what the extent of
// the map counts against that size; 0: space alone.
Clusters nearestCentres(std::span<const LightPoint> points, size_t count, float scale,
                        uint32_t mapSize, float mapWeight, uint64_t seed);

}  // namespace lobelia
