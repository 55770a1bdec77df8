#include "lobelia/lights/filtered_sampling.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"

namespace lobelia {
namespace {

using Level = FilteredSampling::Level;

// A wavy floor; one texel of `spacing` is bright, the others dim or, with holes, some dark.
ReflectiveShadowMap someMap(uint32_t size, float bright, uint32_t spacing, bool holes) {
  ReflectiveShadowMap map;
  map.size = size;
  Rng random(3);
  for (uint32_t i = 0; i < size * size; ++i) {
    LightPoint p;
    const float x = static_cast<float>(i % size) / static_cast<float>(size);
    const float y = static_cast<float>(i / size) / static_cast<float>(size);
    p.p = {x, y, 0.1f * std::sin(9 * x)};
    p.n = normalize(Vec3f{-0.9f * std::cos(9 * x), 0, 1});
    const float power = random.nextUint() % spacing == 0 ? bright : random.next1D();
    p.diffuse = Rgb(0.3f + 0.4f * x, 0.6f - 0.2f * y, 0.5f) * power;
    p.glossy = Rgb(0.2f, 0.1f, 0.3f * y) * power;
    p.axis = normalize(Vec3f{x, y, 1});
    p.sharpness = 20 + 50 * y;
    p.depth = 1, p.group = static_cast<uint16_t>(i % 2);
    if (holes && i % 3 == 0) p = {};
    map.texels.push_back(p);
  }
  return map;
}

Vec3d toDouble(Rgb c) { return {double{c.x}, double{c.y}, double{c.z}}; }
template <class Lights>
Vec3d powerOf(const Lights& lights) {
  Vec3d sum;
  for (const auto& light : lights) sum += toDouble(light.diffuse) + toDouble(light.glossy);
  return sum;
}
template <class Lights>
double luminanceOf(const Lights& lights) {
  double sum = 0;
  for (const auto& l : lights) sum += double{luminance(l.diffuse)} + double{luminance(l.glossy)};
  return sum;
}
std::vector<uint32_t> indices(size_t count) {
  std::vector<uint32_t> all(count);
  for (uint32_t i = 0; i < count; ++i) all[i] = i;
  return all;
}

TEST(MapPyramid, KernelsAreSumsOfTexels) {
  const ReflectiveShadowMap map = someMap(16, 20, 40, true);
  const MapPyramid pyramid(map, false);
  EXPECT_EQ(pyramid.top(), 4);
  const auto boxSum = [&](size_t x0, size_t y0, size_t side) {
    ClusterSums sum;
    for (size_t y = y0; y < y0 + side; ++y)
      for (size_t x = x0; x < x0 + side; ++x) sum += ClusterSums::of(map.texels[y * 16 + x], false);
    return sum;
  };
  const auto expectSame = [&](const ClusterSums& a, const ClusterSums& b) {
    EXPECT_NEAR(a.weight, b.weight, 1e-9);
    EXPECT_NEAR(length(a.place - b.place), 0, 1e-9);
    EXPECT_NEAR(a.square[4], b.square[4], 1e-9);
    EXPECT_NEAR(length(a.diffuse - b.diffuse), 0, 1e-9);
    EXPECT_NEAR(length(a.glossy - b.glossy), 0, 1e-9);
    EXPECT_NEAR(length(a.normal - b.normal), 0, 1e-9);
    EXPECT_NEAR(length(a.axis - b.axis), 0, 1e-9);
  };
  expectSame(pyramid.kernel({3.5f / 16, 10.5f / 16}, 0), boxSum(3, 10, 1));
  expectSame(pyramid.kernel({3.f / 16, 11.f / 16}, 1), boxSum(2, 10, 2));
  expectSame(pyramid.kernel({0.125f, 0.625f}, 2), boxSum(0, 8, 4));
  expectSame(pyramid.kernel({0.9f, 0.3f}, 4), boxSum(0, 0, 16));
  EXPECT_NEAR(pyramid.weight(), boxSum(0, 0, 16).weight, 1e-9);
  // Between texels the mean; between levels that of averages.
  ClusterSums pair = boxSum(3, 10, 1);
  pair += boxSum(4, 10, 1);
  pair *= 0.5;
  expectSame(pyramid.kernel({4.f / 16, 10.5f / 16}, 0), pair);
  ClusterSums between = pyramid.kernel({0.4f, 0.3f}, 1), above = pyramid.kernel({0.4f, 0.3f}, 2);
  between *= 0.75 / 4, above *= 0.25 / 16;
  between += above;
  between *= std::exp2(2 * 1.25);
  expectSame(pyramid.kernel({0.4f, 0.3f}, 1.25f), between);
  EXPECT_NEAR(pyramid.kernelWeight({0.4f, 0.3f}, 1.25f), between.weight, 1e-9);
}

// Algorithm 1 finds kernels with K / N of the power; the original's levels miss it widely.
TEST(FilteredSampling, KernelsHoldTheirShare) {
  const ReflectiveShadowMap map = someMap(64, 30, 100, false);
  const MapPyramid pyramid(map, false);
  FilteredSampling sampling;
  sampling.count = 64;
  for (const double overlap : {1.0, 2.0}) {
    sampling.overlap = overlap;
    const auto relativeError = [&](Level level) {
      sampling.level = level;
      std::vector<float> weights;
      for (const LightPoint& p : map.texels) weights.push_back(p.power());
      const Distribution2D distribution(weights, 64, 64);
      Rng random(1);
      double sum = 0;
      for (int i = 0; i < 1000; ++i) {
        float density;
        const Vec2f at = distribution.sample(random.next2D(), &density);
        const double held = pyramid.kernelWeight(at, kernelLevel(pyramid, at, density, sampling));
        const double error = held * 64 / (overlap * pyramid.weight()) - 1;
        sum += error * error;
      }
      return std::sqrt(sum / 1000);
    };
    EXPECT_LT(relativeError(Level::bisection), 0.01);
    EXPECT_GT(relativeError(Level::original), 0.2);
  }
}

// Also where single texels have more than the power of a light.
TEST(FilteredSampling, PowerIsTheMapsInTheMean) {
  for (const float bright : {30.f, 1000.f}) {
    for (const bool holes : {false, true}) {
      const ReflectiveShadowMap map = someMap(64, bright, 100, holes);
      const double total = luminanceOf(map.texels);
      const auto mean = [&](Level level, Vec3d* colour) {
        double sum = 0;
        constexpr int kSeeds = 64;
        for (uint64_t seed = 0; seed < kSeeds; ++seed) {
          FilteredSampling sampling;
          sampling.count = 100, sampling.seed = seed, sampling.level = level;
          const std::vector<GaussianLight> lights = filteredLights(map, sampling);
          EXPECT_EQ(lights.size(), 100u);
          sum += luminanceOf(lights) / kSeeds;
          *colour += powerOf(lights) / kSeeds;
        }
        return sum;
      };
      Vec3d colour, ignored;
      EXPECT_NEAR(mean(Level::bisection, &colour), total, 1e-3 * total);
      EXPECT_GT(std::abs(mean(Level::original, &ignored) / total - 1), 0.03);
      const Vec3d exact = powerOf(map.texels);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], exact[c], 0.01 * exact[c]) << c;
    }
  }
}

// Kernels hold equal shares of luminance, for every seed; what they hold of a colour varies, and is
// right in the mean.
TEST(FilteredSampling, ColoursAreTheMapsInTheMeanOfManySeeds) {
  const ReflectiveShadowMap map = someMap(64, 30, 100, false);
  constexpr int kSeeds = 2048;
  std::vector<Vec3d> colours(kSeeds);
  parallelFor(colours.size(), 16, [&](size_t seed) {
    FilteredSampling sampling;
    sampling.count = 100, sampling.seed = seed;
    colours[seed] = powerOf(filteredLights(map, sampling));
  });
  Vec3d mean{};
  for (const Vec3d& c : colours) mean += c / kSeeds;
  const Vec3d exact = powerOf(map.texels);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], exact[c], 0.001 * exact[c]) << c;
}

TEST(FilteredSampling, OneLightHasAllOfTheMap) {
  const ReflectiveShadowMap map = someMap(32, 30, 100, true);
  FilteredSampling sampling;
  sampling.count = 1;
  const std::vector<GaussianLight> lights = filteredLights(map, sampling);
  ASSERT_EQ(lights.size(), 1u);
  const GaussianLight all = clusterLight(map.texels, indices(map.texels.size()), false, 0);
  EXPECT_NEAR(length(lights[0].mean - all.mean), 0, 1e-3f);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(lights[0].covariance[i], all.covariance[i], 1e-4f);
  EXPECT_NEAR(length(lights[0].diffuse - all.diffuse), 0, 1e-3f * length(all.diffuse));
  EXPECT_NEAR(lights[0].normalSharpness, all.normalSharpness, 0.01f * all.normalSharpness);
  EXPECT_NEAR(lights[0].sharpness, all.sharpness, 0.01f * all.sharpness);
}

// As many lights as a flat map has texels: each is about a texel, and so are its places.
TEST(FilteredSampling, ManyLightsAreTexels) {
  ReflectiveShadowMap map = someMap(16, 1, 1, false);
  FilteredSampling sampling;
  sampling.count = 256;
  const std::vector<GaussianLight> lights = filteredLights(map, sampling);
  for (const GaussianLight& light : lights) {
    EXPECT_LT(light.covariance[0], 0.06f * 0.06f);
    EXPECT_LT(light.covariance[1], 0.06f * 0.06f);
    for (const GaussianLight::Place& place : light.places) {
      EXPECT_LT(std::abs(place.p.x - light.mean.x), 0.1f);
      EXPECT_LT(std::abs(place.p.y - light.mean.y), 0.1f);
    }
    EXPECT_EQ(light.depth, 1);
  }
}

TEST(FilteredSampling, DarkMapsHaveNoLights) {
  ReflectiveShadowMap map;
  EXPECT_TRUE(filteredLights(map, {}).empty());
  map.size = 4;
  map.texels.resize(16);
  EXPECT_TRUE(filteredLights(map, {}).empty());
  EXPECT_TRUE(nearestCentres(map.texels, 8, 1, 4, 1, 0).order.empty());
  // Of one texel that is lit all lights are its own.
  map.texels[9].diffuse = Rgb(2), map.texels[9].group = 3, map.texels[9].p = {1, 2, 3};
  for (const GaussianLight& light : filteredLights(map, {})) {
    EXPECT_EQ(light.group, 3);
    EXPECT_EQ(light.mean, Vec3f(1, 2, 3));
    EXPECT_EQ(light.places[2].p, Vec3f(1, 2, 3));
  }
}

TEST(FilteredSampling, TheNumberOfThreadsChangesNothing) {
  const ReflectiveShadowMap map = someMap(64, 30, 100, true);
  std::vector<GaussianLight> lights[2], clusters[2];
  for (int i = 0; i < 2; ++i) {
    const ThreadLimit limit(i + 1);
    lights[i] = filteredLights(map, {});
    clusters[i] = clusterLights(map.texels, nearestCentres(map.texels, 200, 1, 64, 1, 9), false, 4);
  }
  for (const auto* run : {lights, clusters}) {
    ASSERT_FALSE(run[0].empty());
    ASSERT_EQ(run[0].size(), run[1].size());
    EXPECT_EQ(0, std::memcmp(run[0].data(), run[1].data(), run[0].size() * sizeof(GaussianLight)));
  }
  FilteredSampling other;
  other.seed = 1;
  EXPECT_NE(filteredLights(map, other)[0].mean, lights[0][0].mean);
}

TEST(NearestCentres, EveryPointWithPowerIsInOneCluster) {
  const ReflectiveShadowMap map = someMap(64, 30, 100, true);
  for (const float mapWeight : {0.f, 1.f}) {
    const Clusters clusters = nearestCentres(map.texels, 150, 1, 64, mapWeight, 2);
    EXPECT_GT(clusters.ends.size(), 100u);
    EXPECT_LE(clusters.ends.size(), 150u);
    const std::set<uint32_t> members(clusters.order.begin(), clusters.order.end());
    EXPECT_EQ(members.size(), clusters.order.size());
    for (uint32_t i = 0; i < map.texels.size(); ++i)
      EXPECT_EQ(members.contains(i), map.texels[i].power() > 0);
    for (size_t k = 1; k < clusters.ends.size(); ++k)
      EXPECT_GT(clusters.ends[k], clusters.ends[k - 1]);
    const Vec3d power = powerOf(clusterLights(map.texels, clusters, false, 0));
    const Vec3d exact = powerOf(map.texels);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(power[c], exact[c], 1e-5 * exact[c]);
  }
}

// Of points along a line clusters are intervals; when every point is a centre, points.
TEST(NearestCentres, ClustersAreNeighbours) {
  std::vector<LightPoint> points(1000);
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].p = {50 + 0.1f * static_cast<float>(i * 7 % 1000), 3, 0};
    points[i].diffuse = Rgb(1);
  }
  const Clusters clusters = nearestCentres(points, 10, 100, 32, 0, 2);
  ASSERT_EQ(clusters.ends.size(), 10u);
  std::vector<std::pair<float, float>> intervals;
  for (size_t k = 0; k < 10; ++k) {
    Bounds3f box;
    for (size_t i = k == 0 ? 0 : clusters.ends[k - 1]; i < clusters.ends[k]; ++i)
      box.add(points[clusters.order[i]].p);
    intervals.push_back({box.lo.x, box.hi.x});
  }
  std::sort(intervals.begin(), intervals.end());
  for (size_t k = 1; k < 10; ++k) EXPECT_GT(intervals[k].first, intervals[k - 1].second);
  EXPECT_EQ(nearestCentres(points, 1000, 100, 32, 0, 2).ends.size(), 1000u);
}

// Centres are as dense as power.
TEST(NearestCentres, CentresFollowPower) {
  std::vector<LightPoint> points(2000);
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].p = {static_cast<float>(i), 0, 0};
    points[i].diffuse = Rgb(i < 1000 ? 9.f : 1.f);
  }
  const std::vector<GaussianLight> lights =
      clusterLights(points, nearestCentres(points, 100, 2000, 64, 0, 5), false, 0);
  const auto left = std::count_if(lights.begin(), lights.end(),
                                  [](const GaussianLight& l) { return l.mean.x < 1000; });
  EXPECT_NEAR(static_cast<double>(left), 90, 3);
}

// What is in one place is told apart by the map alone.
TEST(NearestCentres, TheMapCounts) {
  std::vector<LightPoint> points(32 * 32);
  for (LightPoint& p : points) p.diffuse = Rgb(1);
  EXPECT_EQ(nearestCentres(points, 20, 1, 32, 0, 2).ends.size(), 1u);
  const Clusters clusters = nearestCentres(points, 20, 1, 32, 1, 2);
  EXPECT_EQ(clusters.ends.size(), 20u);
  const uint32_t first = clusters.order[0];
  for (size_t i = 0; i < clusters.ends[0]; ++i) {
    const uint32_t x = clusters.order[i] % 32;
    EXPECT_LT(std::max(x, first % 32) - std::min(x, first % 32), 24u);
  }
}

}  // namespace
}  // namespace lobelia
