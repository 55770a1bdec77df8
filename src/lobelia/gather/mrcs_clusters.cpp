#include "lobelia/gather/mrcs_clusters.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/gather/mrcs_sampling.h"

namespace lobelia::gather {
namespace {

// With an error limit: clusters of the first attempt, and how many more the splitting phase may add
// before both phases begin again with more.
constexpr size_t kFirstClusters = 256;
constexpr size_t kMostGrowth = 2;

Clustering bothPhases(const LightColumns& columns, size_t count, size_t most,
                      const ClusterSettings& settings, uint64_t seed, Context& context) {
  const auto sampled =
      static_cast<size_t>(std::floor(settings.sampledShare * static_cast<double>(count)));
  Clustering clustering =
      sampleClusters(columns, std::clamp<size_t>(sampled, 1, count), seed, context);
  splitClusters(columns, most, settings.errorLimit, hashCombine(seed, 1), &clustering, context);
  return clustering;
}

// What float sums over many lights lose: flushed to double every so many.
constexpr size_t kFlush = 64;

}  // namespace

double uniformNumber(uint64_t seed, uint64_t index) {
  return static_cast<double>(hashCombine(seed, index) >> 11) * 0x1p-53;
}

double Clustering::rowError(const LightColumns& columns) const {
  return columns.rowNorm > 0 ? std::sqrt(std::max(rowCost, 0.0)) / columns.rowNorm : 1;
}
double Clustering::checkError(const LightColumns& columns) const {
  if (!(columns.checkNorm > 0)) return rowError(columns);
  return std::sqrt(std::max(checkCost, 0.0)) / columns.checkNorm;
}

LightCluster measureCluster(const LightColumns& columns, std::span<const uint32_t> order,
                            size_t begin, size_t end) {
  const std::span<const uint32_t> lights = order.subspan(begin, end - begin);
  const size_t dims = columns.dims, stride = columns.stride();
  AlignedFloats vector(stride), partial(stride, 0.f);
  std::vector<double> sum(stride, 0.0);
  LightCluster cluster;
  cluster.begin = begin, cluster.end = end;
  for (const uint32_t i : lights) cluster.weight += double{columns.weight[i]};
  double squares = 0, rows = 0, checks = 0;  // w |a|^2; |vector|^2 / probability
  for (size_t i = 0; i < lights.size(); ++i) {
    columns.load(lights[i], vector.data());
    const double w = double{columns.weight[lights[i]]};
    const double inverse = w * w / drawProbability(w, cluster);
    const double square = double{dotProduct(vector.data(), vector.data(), dims)};
    squares += w * (square + columns.unseenOf(lights[i]));
    rows += inverse * square;
    checks += inverse * double{dotProduct(&vector[dims], &vector[dims], columns.checkDims)};
    addScaled(static_cast<float>(w), vector.data(), stride, partial.data());
    if (i % kFlush != kFlush - 1 && i + 1 != lights.size()) continue;
    for (size_t d = 0; d < stride; ++d) sum[d] += double{std::exchange(partial[d], 0.f)};
  }
  if (lights.size() < 2) return cluster;  // costs nothing, exactly
  double rowsOfSum = 0, checksOfSum = 0;
  for (size_t d = 0; d < dims; ++d) rowsOfSum += sum[d] * sum[d];
  for (size_t d = dims; d < stride; ++d) checksOfSum += sum[d] * sum[d];
  const double unseenOfSum = columns.unseen * static_cast<double>(lights.size());
  cluster.cost = std::max(cluster.weight * squares - rowsOfSum - unseenOfSum, 0.0);
  cluster.rowCost = std::max(rows - rowsOfSum, 0.0);
  cluster.checkCost = std::max(checks - checksOfSum, 0.0);
  return cluster;
}

Clustering clusterLights(const LightColumns& columns, const ClusterSettings& settings,
                         Context& context) {
  const StageTimer timer(context, "cluster");
  const size_t most = std::min(settings.count, columns.count);
  if (settings.errorLimit <= 0)
    return bothPhases(columns, most, most, settings, settings.seed, context);
  for (size_t attempt = 0, count = std::min(kFirstClusters, most);; ++attempt) {
    const size_t limit = std::min(count * kMostGrowth, most);
    Clustering clustering =
        bothPhases(columns, count, limit, settings, hashCombine(settings.seed, attempt), context);
    const double error = clustering.checkError(columns);
    if (error <= settings.errorLimit || limit == most || context.cancelled()) return clustering;
    // The cost falls about as one over the number of clusters.
    const double wanted = static_cast<double>(limit) * std::pow(error / settings.errorLimit, 2);
    count = static_cast<size_t>(
        std::min(std::min(wanted, 4.0 * static_cast<double>(limit)), static_cast<double>(most)));
  }
}

}  // namespace lobelia::gather
