// Sampling phase of the clustering; the head of mrcs_clusters.h says what for.
#include "lobelia/gather/mrcs_sampling.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"

namespace lobelia::gather {
namespace {

constexpr size_t kShares = 256;  // whose sums are added in their order
constexpr size_t kChunk = 384;   // lights unpacked at once

// Sums over all lights, a = vector / w without unseen parts.
struct Sums {
  double weight = 0;           // w
  double squares = 0;          // w |vector / w|^2, with unseen parts
  std::vector<double> vector;  // w a
};

double squaredWithUnseen(const LightColumns& columns, size_t i, const float* vector) {
  return double{dotProduct(vector, vector, columns.dims)} + columns.unseenOf(i);
}

Sums sumLights(const LightColumns& columns) {
  std::vector<Sums> shares(kShares);
  parallelFor(kShares, 1, [&](size_t s) {
    Sums& sums = shares[s];
    sums.vector.assign(columns.dims, 0.0);
    AlignedFloats vector(columns.stride());
    for (size_t i = s * columns.count / kShares; i < (s + 1) * columns.count / kShares; ++i) {
      columns.load(i, vector.data());
      const double w = double{columns.weight[i]};
      sums.weight += w;
      sums.squares += w * squaredWithUnseen(columns, i, vector.data());
      for (size_t d = 0; d < columns.dims; ++d) sums.vector[d] += w * double{vector[d]};
    }
  });
  Sums all;
  all.vector.assign(columns.dims, 0.0);
  for (const Sums& share : shares) {
    all.weight += share.weight;
    all.squares += share.squares;
    for (size_t d = 0; d < columns.dims; ++d) all.vector[d] += share.vector[d];
  }
  return all;
}

// Running sums of what each light adds to the cost of all as one cluster,
// alpha_i = sum_j w_i w_j |difference|^2 = w_i (|a_i|^2 sum w + sum w |a|^2 - 2 a_i . sum w a).
std::vector<double> cumulativeAlphas(const LightColumns& columns) {
  const Sums sums = sumLights(columns);
  std::vector<double> alphas(columns.count);
  parallelRanges(columns.count, 4096, [&](size_t begin, size_t end) {
    AlignedFloats vector(columns.stride());
    for (size_t i = begin; i < end; ++i) {
      columns.load(i, vector.data());
      double dot = 0;
      for (size_t d = 0; d < columns.dims; ++d) dot += double{vector[d]} * sums.vector[d];
      const double own = squaredWithUnseen(columns, i, vector.data());
      // The unseen part is not at right angles to itself.
      const double unseen = columns.unseenOf(i) * double{columns.weight[i]};
      const double alpha =
          double{columns.weight[i]} * (own * sums.weight + sums.squares - 2 * (dot + unseen));
      alphas[i] = std::max(alpha, 0.0);
    }
  });
  for (size_t i = 1; i < alphas.size(); ++i) alphas[i] += alphas[i - 1];
  return alphas;
}

struct Centre {
  uint32_t light = 0;
  double drawn = 0;  // sum of 1 / probability
};

// In the order of their lights.
std::vector<Centre> drawCentres(const std::vector<double>& cumulative, size_t count,
                                uint64_t seed) {
  const double total = cumulative.back();
  if (!(total > 0)) return {{0, 1}};  // all columns are alike
  std::vector<Centre> centres;
  std::vector<uint32_t> draws;
  std::vector<bool> known(cumulative.size(), false);
  size_t distinct = 0;
  // With replacement until enough are distinct; a few dominant lights must not hold it up for ever.
  while (distinct < count && draws.size() < 64 * count) {
    const double u = uniformNumber(seed, draws.size()) * total;
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), u);
    const size_t light =
        std::min<size_t>(static_cast<size_t>(at - cumulative.begin()), cumulative.size() - 1);
    draws.push_back(static_cast<uint32_t>(light));
    if (!known[light]) ++distinct;
    known[light] = true;
  }
  std::sort(draws.begin(), draws.end());
  for (const uint32_t light : draws) {
    if (centres.empty() || centres.back().light != light) centres.push_back({light, 0});
    const double alpha = cumulative[light] - (light > 0 ? cumulative[light - 1] : 0);
    centres.back().drawn += total / std::max(alpha, 1e-300);
  }
  return centres;
}

// Index of the centre that each light goes to.
std::vector<uint32_t> assign(const LightColumns& columns, const std::vector<Centre>& centres,
                             Context& context) {
  CentreTable table(centres.size(), columns.dims);
  double largest = 0;
  for (const Centre& c : centres)
    largest = std::max(largest, c.drawn * double{columns.weight[c.light]});
  AlignedFloats vector(columns.stride());
  for (size_t k = 0; k < centres.size(); ++k) {
    const size_t i = centres[k].light;
    columns.load(i, vector.data());
    const double gain = centres[k].drawn * double{columns.weight[i]} / largest;
    table.set(k, vector.data(), static_cast<float>(squaredWithUnseen(columns, i, vector.data())),
              static_cast<float>(gain));
  }
  std::vector<uint32_t> nearest(columns.count);
  parallelRanges(columns.count, kChunk, [&](size_t begin, size_t end) {
    if (context.cancelled()) return;
    AlignedFloats vectors((end - begin) * columns.dims), one(columns.stride());
    float squares[kChunk];
    for (size_t i = begin; i < end; ++i) {
      columns.load(i, one.data());
      std::copy_n(one.begin(), columns.dims, vectors.begin() + (i - begin) * columns.dims);
      squares[i - begin] = static_cast<float>(squaredWithUnseen(columns, i, one.data()));
    }
    nearestCentres(vectors.data(), squares, end - begin, table, &nearest[begin]);
  });
  // A centre's distance to itself is 0, unseen part included.
  for (size_t k = 0; k < centres.size(); ++k) nearest[centres[k].light] = static_cast<uint32_t>(k);
  return nearest;
}

}  // namespace

Clustering sampleClusters(const LightColumns& columns, size_t count, uint64_t seed,
                          Context& context) {
  Clustering result;
  if (columns.count == 0) return result;
  const std::vector<Centre> centres = drawCentres(cumulativeAlphas(columns), count, seed);
  const std::vector<uint32_t> nearest = assign(columns, centres, context);
  std::vector<size_t> ends(centres.size() + 1, 0);  // counting sort by cluster
  for (const uint32_t k : nearest) ++ends[k + 1];
  for (size_t k = 0; k < centres.size(); ++k) ends[k + 1] += ends[k];
  result.clusters.resize(centres.size());
  for (size_t k = 0; k < centres.size(); ++k)
    result.clusters[k].begin = ends[k], result.clusters[k].end = ends[k + 1];
  result.order.resize(columns.count);
  for (size_t i = 0; i < columns.count; ++i)
    result.order[ends[nearest[i]]++] = static_cast<uint32_t>(i);
  parallelFor(result.clusters.size(), 1, [&](size_t k) {
    LightCluster& cluster = result.clusters[k];
    cluster = measureCluster(columns, result.order, cluster.begin, cluster.end);
  });
  for (const LightCluster& cluster : result.clusters) {
    result.cost += cluster.cost;
    result.rowCost += cluster.rowCost;
    result.checkCost += cluster.checkCost;
  }
  return result;
}

}  // namespace lobelia::gather
