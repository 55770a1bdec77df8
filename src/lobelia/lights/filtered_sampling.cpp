// Deviations:
//  - With the paper's levels (bisection) a light's power is its share 1 / N of the map's, whatever
//    its kernel holds. Where the bisection finds its level that is what a kernel's power over K is.
//    But where one texel alone has more than K / N of the power, the smallest kernel holds too
//    much: it is drawn more than once, and each time its light would have all of that. Without the
//    scaling the sum of the lights' powers would be more than the map's. What kernels do not say is
//    their colour, so that the sum of each channel is the map's only as far as kernels are small.
//  - Places for shadow rays, which the paper's lights have not, are drawn among texels of the
//    kernel's square.
//  - k-means: a kd-tree by nanoflann instead of a radix tree; centres that were drawn twice count
//    once.
#include "lobelia/lights/filtered_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/base/sampling.h"

namespace lobelia {
namespace {

constexpr uint64_t kPlaceStream = 0x706c616365ull;

size_t sizeOf(const MapPyramid& map) { return map.map().size; }

// Up to 8 x 8 of the texels of the kernel's square, and the one at its centre.
std::vector<uint32_t> texelsOf(const MapPyramid& map, Vec2f at, float level, size_t centre,
                               Rng& random) {
  constexpr int kMost = 8;
  const float size = static_cast<float>(sizeOf(map)), side = std::exp2(level);
  const int steps = std::clamp(static_cast<int>(std::ceil(side)), 1, kMost);
  const auto texelAlong = [&](float middle, int step) {
    const float u = side > kMost ? random.next1D() : 0.5f;
    return std::floor(middle * size +
                      side * ((static_cast<float>(step) + u) / static_cast<float>(steps) - 0.5f));
  };
  std::vector<uint32_t> texels;
  for (int y = 0; y < steps; ++y) {
    for (int x = 0; x < steps; ++x) {
      const float column = texelAlong(at.x, x), row = texelAlong(at.y, y);
      if (column < 0 || row < 0 || column >= size || row >= size) continue;
      texels.push_back(static_cast<uint32_t>(row) * map.map().size + static_cast<uint32_t>(column));
    }
  }
  texels.push_back(static_cast<uint32_t>(centre));
  std::sort(texels.begin(), texels.end());
  texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
  return texels;
}

std::optional<GaussianLight> kernelLight(const MapPyramid& map, Vec2f at, float density,
                                         size_t centre, const FilteredSampling& sampling,
                                         uint64_t seed) {
  const float level = kernelLevel(map, at, density, sampling);
  ClusterSums sums = map.kernel(at, level);
  if (!(sums.weight > 0)) return std::nullopt;
  sums *= sampling.level == FilteredSampling::Level::bisection
              ? map.weight() / (static_cast<double>(sampling.count) * sums.weight)
              : 1 / sampling.overlap;
  GaussianLight light = sums.light(sampling.toksvig);
  const LightPoint& texel = map.map().texels[centre];
  light.group = texel.group, light.depth = texel.depth;
  Rng random(seed, kPlaceStream);
  choosePlaces(map.map().texels, texelsOf(map, at, level, centre, random), seed, &light);
  return light;
}

// Indices of points, in proportion to power, each at most once; ascending.
std::vector<uint32_t> drawCentres(std::span<const LightPoint> points, size_t count, uint64_t seed) {
  double total = 0;
  for (const LightPoint& p : points) total += std::max(0.0, double{p.power()});
  std::vector<uint32_t> centres;
  Rng random(seed);
  const double step = total / static_cast<double>(count);
  double sum = 0, next = step * double{random.next1D()};
  size_t drawn = 0;
  for (uint32_t i = 0; i < points.size(); ++i) {
    sum += std::max(0.0, double{points[i].power()});
    if (drawn == count || !(next < sum)) continue;
    centres.push_back(i);
    while (drawn < count && next < sum)
      next = step * (static_cast<double>(++drawn) + double{random.next1D()});
  }
  return centres;
}

// The nearest of some points in space and on a map; distances count in units of the scene's scale.
class CentreTree {
 public:
  CentreTree(std::span<const LightPoint> points, const std::vector<uint32_t>& centres, float scale,
             uint32_t mapSize, float mapWeight)
      : points_(points),
        toScene_(1 / scale),
        mapSize_(mapSize),
        toMap_(mapWeight > 0 ? mapWeight / static_cast<float>(mapSize) : 0.f) {
    for (const uint32_t c : centres) cloud_.places.push_back(placeOf(c));
    index_.emplace(kDimensions, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf));
  }
  uint32_t nearest(size_t point) const {
    const Place query = placeOf(point);
    uint32_t found = 0;
    float distance2 = 0;
    index_->knnSearch(query.data(), 1, &found, &distance2);
    return found;
  }

 private:
  static constexpr int kDimensions = 5;
  static constexpr size_t kLeaf = 8;
  using Place = std::array<float, kDimensions>;
  struct Cloud {
    std::vector<Place> places;
    size_t kdtree_get_point_count() const { return places.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return places[i][axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Distance = nanoflann::L2_Simple_Adaptor<float, Cloud, float, uint32_t>;
  using Index = nanoflann::KDTreeSingleIndexAdaptor<Distance, Cloud, kDimensions, uint32_t>;

  Place placeOf(size_t i) const {
    const Vec3f p = points_[i].p * toScene_;
    if (!(toMap_ > 0)) return {p.x, p.y, p.z, 0, 0};
    const size_t column = i % mapSize_, row = i / mapSize_;
    return {p.x, p.y, p.z, toMap_ * static_cast<float>(column), toMap_ * static_cast<float>(row)};
  }

  std::span<const LightPoint> points_;
  float toScene_;
  uint32_t mapSize_;
  float toMap_;  // from texels
  Cloud cloud_;
  std::optional<Index> index_;
};

constexpr uint32_t kNone = 0xffffffffu;

// Counting sort by cluster; kNone is of no cluster.
Clusters sorted(const std::vector<uint32_t>& clusterOf, size_t count) {
  std::vector<uint32_t> starts(count + 1, 0);
  for (const uint32_t c : clusterOf)
    if (c != kNone) ++starts[c + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  Clusters clusters;
  clusters.order.resize(starts.back());
  for (size_t c = 0; c < count; ++c)
    if (starts[c + 1] > starts[c]) clusters.ends.push_back(starts[c + 1]);
  for (uint32_t i = 0; i < clusterOf.size(); ++i)
    if (clusterOf[i] != kNone) clusters.order[starts[clusterOf[i]]++] = i;
  return clusters;
}

}  // namespace

float kernelLevel(const MapPyramid& map, Vec2f at, float density,
                  const FilteredSampling& sampling) {
  const double share = sampling.overlap / static_cast<double>(sampling.count);
  float low = 0, high = static_cast<float>(map.top());
  if (sampling.level == FilteredSampling::Level::original) {
    const double texels = static_cast<double>(sizeOf(map) * sizeOf(map));
    const double level = 0.5 * std::log2(share * texels / double{density});
    return std::clamp(static_cast<float>(level), low, high);
  }
  constexpr int kSteps = 16;
  for (int i = 0; i < kSteps; ++i) {
    const float middle = 0.5f * (low + high);
    (map.kernelWeight(at, middle) < share * map.weight() ? low : high) = middle;
  }
  return 0.5f * (low + high);
}

std::vector<GaussianLight> filteredLights(const ReflectiveShadowMap& map,
                                          const FilteredSampling& sampling) {
  if (map.texels.empty() || sampling.count == 0) return {};
  const MapPyramid pyramid(map, sampling.toksvig);
  if (!(pyramid.weight() > 0)) return {};
  std::vector<float> weights;
  for (const LightPoint& texel : map.texels) weights.push_back(texel.power());
  const int size = static_cast<int>(map.size);
  const Distribution2D distribution(weights, size, size);

  std::vector<Vec2f> numbers;
  for (uint32_t i = 0; i < sampling.count; ++i)
    numbers.push_back(Sampler(sampling.seed, 0, i).next2D());
  std::vector<size_t> cells(numbers.size());
  distribution.prefetch(numbers, cells);
  std::vector<std::optional<GaussianLight>> made(sampling.count);
  parallelFor(made.size(), 16, [&](size_t i) {
    float density = 0;
    const Vec2f at = distribution.sample(numbers[i], &density);
    made[i] = kernelLight(pyramid, at, density, cells[i], sampling, hashCombine(sampling.seed, i));
  });
  std::vector<GaussianLight> lights;
  for (const auto& light : made)
    if (light) lights.push_back(*light);
  return lights;
}

Clusters nearestCentres(std::span<const LightPoint> points, size_t count, float scale,
                        uint32_t mapSize, float mapWeight, uint64_t seed) {
  if (count == 0) return {};
  const std::vector<uint32_t> centres = drawCentres(points, count, seed);
  if (centres.empty()) return {};
  const CentreTree tree(points, centres, scale, mapSize, mapWeight);
  std::vector<uint32_t> clusterOf(points.size(), kNone);
  parallelFor(points.size(), 1024, [&](size_t i) {
    if (points[i].power() > 0) clusterOf[i] = tree.nearest(i);
  });
  return sorted(clusterOf, centres.size());
}

}  // namespace lobelia
