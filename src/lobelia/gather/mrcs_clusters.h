// Clusters of lights whose columns of the reduced matrix point the same way: the clustering of
// matrix row-column sampling [Hasan07 section 5], sampling phase and splitting phase.
//
// A light's vector is its column with its unseen part (mrcs_columns.h), which is at right angles to
// those of all others; w is its length. A cluster that one of its lights stands for, drawn in
// proportion to w and scaled by (sum of w) / w, errs by
//   cost = (sum w)^2 - |sum of vectors|^2 = 1/2 sum_ij w_i w_j |direction_i - direction_j|^2
// in the mean of squares. Sketches keep differences of vectors, not lengths, so cost is computed
// from the differences: (sum w)(sum w |a|^2) - |sum w a|^2, a = vector / w.
//
// Deviations: a fifth of the probability is shared evenly (drawProbability()); the splitting phase
// takes the eight most expensive clusters at once, in parallel; and the number of clusters may be
// left to a limit of the error, predicted from the check rows.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/gather/mrcs_columns.h"

namespace lobelia::gather {

struct LightCluster {
  size_t begin = 0, end = 0;  // of Clustering::order
  double weight = 0;          // sum of w
  double cost = 0;            // with unseen parts: what clustering makes small
  // Expected squared errors, as representatives are drawn, in the rows and in the check rows.
  double rowCost = 0, checkCost = 0;
  size_t size() const { return end - begin; }
};

// A light stands for its cluster with this probability: by its weight, and to a share evenly. The
// weights are what some rows show; where they show little of a light that matters elsewhere, the
// even share bounds by how much it is scaled when drawn, at size / kEvenShare. It costs little: a
// cluster of lights that are alike but for their weight errs by kEvenShare of its squared light.
inline constexpr double kEvenShare = 0.2;
inline double drawProbability(double weight, const LightCluster& cluster) {
  return (1 - kEvenShare) * weight / cluster.weight +
         kEvenShare / static_cast<double>(cluster.size());
}

struct ClusterSettings {
  size_t count = 1000;  // of clusters; at most so many when there is an errorLimit
  // Relative error (below) in the check rows at which to stop; 0: none.
  double errorLimit = 0;
  double sampledShare = 2.0 / 3;  // of the clusters that the sampling phase makes
  uint64_t seed = 0;
};

struct Clustering {
  std::vector<uint32_t> order;  // numbers of lights, cluster after cluster
  std::vector<LightCluster> clusters;
  double cost = 0, rowCost = 0, checkCost = 0;  // sums over the clusters
  // sqrt(cost in the rows) / |sum of all columns|; 1 where no row is lit. Of the check rows: as of
  // the rows where none of them is lit.
  double rowError(const LightColumns& columns) const;
  double checkError(const LightColumns& columns) const;
};

// Books seconds to "cluster". When cancelled, what it returns is of no use.
Clustering clusterLights(const LightColumns& columns, const ClusterSettings& settings,
                         Context& context);

// The costs of order[begin, end) as one cluster.
LightCluster measureCluster(const LightColumns& columns, std::span<const uint32_t> order,
                            size_t begin, size_t end);

}  // namespace lobelia::gather
