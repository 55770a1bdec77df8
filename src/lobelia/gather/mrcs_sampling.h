// The two phases of clusterLights() (mrcs_clusters.h).
#pragma once

#include "lobelia/gather/mrcs_clusters.h"

namespace lobelia::gather {

// Sampling phase: `count` centres drawn in proportion to what they add to the cost of all lights as
// one cluster; every light goes to the nearest, by w_i w_k (times of drawing) |difference|^2.
Clustering sampleClusters(const LightColumns& columns, size_t count, uint64_t seed,
                          Context& context);

// Splitting phase: the most expensive clusters are split in two until there are `count` or the
// error is met. A cluster is cut across the line from a light drawn by w to one drawn by its
// distance from that, where the costs of both sides are least.
void splitClusters(const LightColumns& columns, size_t count, double errorLimit, uint64_t seed,
                   Clustering* clustering, Context& context);

// A number in [0, 1) with 53 bits.
double uniformNumber(uint64_t seed, uint64_t index);

}  // namespace lobelia::gather
