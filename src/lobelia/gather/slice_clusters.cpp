#include "lobelia/gather/slice_clusters.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/mrcs_sampling.h"

namespace lobelia::gather {
namespace {

constexpr size_t kShares = 256;  // of the lights, whose sums are added in their order

size_t columnLength(size_t rows) {
  return (3 * rows + 1 + kMrcsLanes - 1) / kMrcsLanes * kMrcsLanes;
}

// What a share of the lights says about the unseen part.
struct Share {
  double hardlySeen = 0;
  size_t hardlySeenCount = 0;
  float least = 3e38f;
};

// Light i's values in the rows; returns how many rows see it.
size_t takeRows(const LightColumns& columns, size_t i, std::span<const RowFactor> rows,
                float* column, float* values) {
  columns.load(i, column);
  const float weight = columns.weight[i];
  size_t seen = 0;
  for (const RowFactor& row : rows) {
    float largest = 0;
    for (size_t c = 0; c < 3; ++c) {
      *values = column[3 * row.row + c] * weight * row.factor;
      largest = std::max(largest, *values++);
    }
    if (largest > 0) ++seen;
  }
  return seen;
}

}  // namespace

LightColumns columnsOfRows(const LightColumns& columns, std::span<const RowFactor> rows) {
  LightColumns out;
  out.count = columns.count;
  out.dims = columnLength(rows.size());
  const float elsewhere = kElsewhereFactor / std::sqrt(static_cast<float>(columns.dims) / 3);
  out.whole.assign(out.count * out.dims, 0.f);
  out.weight.resize(out.count);
  out.scale.resize(out.count);
  std::vector<Share> shares(kShares);
  parallelFor(kShares, 1, [&](size_t s) {
    AlignedFloats column(columns.stride());
    for (size_t i = s * out.count / kShares; i < (s + 1) * out.count / kShares; ++i) {
      float* values = &out.whole[i * out.dims];
      const size_t seen = takeRows(columns, i, rows, column.data(), values);
      values[3 * rows.size()] = elsewhere * columns.weight[i] *
                                std::sqrt(dotProduct(column.data(), column.data(), columns.dims));
      const float length = std::sqrt(dotProduct(values, values, out.dims));
      out.weight[i] = length;
      if (seen <= 1) shares[s].hardlySeen += double{length}, ++shares[s].hardlySeenCount;
      if (length > 0) shares[s].least = std::min(shares[s].least, length);
    }
  });
  Share all;
  for (const Share& share : shares) {
    all.hardlySeen += share.hardlySeen, all.hardlySeenCount += share.hardlySeenCount;
    all.least = std::min(all.least, share.least);
  }
  out.unseen = squaredUnseen(all.hardlySeen, all.hardlySeenCount, all.least);
  parallelFor(out.count, 4096, [&](size_t i) {
    const double length = double{out.weight[i]};
    out.weight[i] = static_cast<float>(std::sqrt(length * length + out.unseen));
    out.scale[i] = 1 / out.weight[i];
  });
  return out;
}

size_t sliceBytes(size_t rows) {
  // What splitting the largest cluster, of all lights at worst, keeps of a light
  // (mrcs_splitting.cpp).
  constexpr size_t kSplitBytes = sizeof(double) + sizeof(std::pair<double, uint32_t>);
  return columnLength(rows) * sizeof(float) + 2 * sizeof(float) + sizeof(uint32_t) + kSplitBytes;
}

std::vector<RowFactor> rowsOfSlice(const ReceiverSlices& slices, size_t slice, size_t rows) {
  const std::vector<ReceiverSlices::Neighbour> near = slices.neighbours(slice, rows);
  float mean = 0;
  for (const auto& n : near) mean += n.squaredDistance / static_cast<float>(near.size());
  std::vector<RowFactor> out;
  for (const auto& n : near) {
    const float factor = mean > 0 ? 1 / (1 + n.squaredDistance / mean) : 1.f;
    out.push_back({n.slice, factor});
  }
  return out;
}

std::vector<Representative> chooseForSlice(const LightColumns& columns, const Clustering& global,
                                           std::span<const RowFactor> rows, size_t count,
                                           uint64_t seed) {
  const LightColumns local = columnsOfRows(columns, rows);
  Clustering clustering;
  clustering.order = global.order;
  clustering.clusters.resize(global.clusters.size());
  parallelFor(clustering.clusters.size(), 1, [&](size_t k) {
    const LightCluster& cluster = global.clusters[k];
    clustering.clusters[k] = measureCluster(local, clustering.order, cluster.begin, cluster.end);
  });
  Context quiet;  // progress is told slice by slice
  splitClusters(local, count, 0, seed, &clustering, quiet);
  return drawRepresentatives(local, clustering, hashCombine(seed, 1));
}

}  // namespace lobelia::gather
