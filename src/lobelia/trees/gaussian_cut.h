// Virtual spherical Gaussian lights from a cut of a tree over point lights: moments add up, so that
// every node is one (past [P001], which has filtered importance sampling and k-means).
#pragma once

#include "lobelia/lights/cluster_sums.h"

namespace lobelia::trees {

// Clusters of about equal spread of places and directions, by power: the node with the most is
// split, until there are `count` or all are single points. Points without power are left out.
// leastVariance: what the places of a cluster vary by at least (trace, mean square distance), since
// its points stand for the surface around them. scale: size of the scene. The same for any number
// of threads.
struct CutClusters {
  Clusters clusters;
  std::vector<float> leastVariance;
};
CutClusters cutClusters(std::span<const LightPoint> points, size_t count, float scale);

// Their lights. Widened across the mean normal to leastVariance.
std::vector<GaussianLight> cutLights(std::span<const LightPoint> points, size_t count, float scale,
                                     bool toksvig, uint64_t seed);

}  // namespace lobelia::trees
