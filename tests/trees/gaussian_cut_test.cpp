// Clusters by cuts of a tree over point lights.
#include "lobelia/trees/gaussian_cut.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"

namespace lobelia::trees {
namespace {

// On the floor and on a wall of a unit room; one in eight without power.
std::vector<LightPoint> pointsOf(size_t count, uint64_t seed) {
  Rng rng(seed);
  std::vector<LightPoint> points(count);
  for (size_t i = 0; i < count; ++i) {
    LightPoint& point = points[i];
    const Vec2f u = rng.next2D();
    const bool floor = rng.next1D() < 0.5f;
    point.p = floor ? Vec3f{u.x, u.y, 0} : Vec3f{0, u.x, u.y};
    point.n = floor ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0};
    point.axis = normalize(point.n + 0.5f * sampleSphereUniform(rng.next2D()));
    point.sharpness = 10 + 90 * rng.next1D();
    if (i % 8 == 0) continue;
    point.diffuse = Rgb(rng.next1D(), rng.next1D(), rng.next1D());
    point.glossy = Rgb(rng.next1D(), rng.next1D(), rng.next1D());
  }
  return points;
}

template <class Lights>
Vec3d powerOf(const Lights& lights) {
  Vec3d sum;
  for (const auto& light : lights) {
    const Rgb power = light.diffuse + light.glossy;
    sum += {double{power.x}, double{power.y}, double{power.z}};
  }
  return sum;
}

double variance(const GaussianLight& light) {
  return static_cast<double>(light.covariance[0] + light.covariance[1] + light.covariance[2]);
}

TEST(GaussianCut, KeepsAllPower) {
  const std::vector<LightPoint> points = pointsOf(3000, 1);
  const Vec3d all = powerOf(points);
  for (const size_t count : {1u, 2u, 16u, 300u, 5000u}) {
    const std::vector<GaussianLight> lights = cutLights(points, count, 2, false, 1);
    const Vec3d sum = powerOf(lights);
    EXPECT_EQ(lights.size(), std::min<size_t>(count, 3000 - 375));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], all[c], 1e-5 * all[c]) << count;
  }
}

TEST(GaussianCut, ClustersAreDisjointAndWhole) {
  const std::vector<LightPoint> points = pointsOf(500, 2);
  const CutClusters cut = cutClusters(points, 40, 2);
  std::vector<uint32_t> members = cut.clusters.order;
  ASSERT_EQ(cut.clusters.ends.size(), 40u);
  EXPECT_EQ(cut.clusters.ends.back(), members.size());
  EXPECT_TRUE(std::is_sorted(cut.clusters.ends.begin(), cut.clusters.ends.end()));
  std::sort(members.begin(), members.end());
  EXPECT_EQ(std::unique(members.begin(), members.end()), members.end());
  for (const uint32_t i : members) EXPECT_GT(points[i].power(), 0.f);
  EXPECT_EQ(members.size(), 500u - 63u);
}

// Two clusters are floor and wall, or halves of both; sixty-four hold one surface each but for a
// few.
TEST(GaussianCut, MoreLightsSpreadLess) {
  const std::vector<LightPoint> points = pointsOf(4000, 3);
  double before = 1e30;
  for (const size_t count : {1u, 4u, 16u, 64u, 256u}) {
    double spread = 0, power = 0;
    for (const GaussianLight& light : cutLights(points, count, 2, false, 1)) {
      const double own = static_cast<double>(luminance(light.diffuse + light.glossy));
      spread += own * variance(light), power += own;
    }
    EXPECT_LT(spread / power, 0.5 * before) << count;
    before = spread / power;
  }
  size_t mixed = 0;
  for (const GaussianLight& light : cutLights(points, 64, 2, false, 1))
    if (light.normalSharpness < 100) ++mixed;
  EXPECT_LT(mixed, 8u);
}

// A single point stands for the surface around it: across its normal it has an extent.
TEST(GaussianCut, SinglePointsHaveTheExtentOfTheirSurroundings) {
  const std::vector<LightPoint> points = pointsOf(800, 4);
  const std::vector<GaussianLight> lights = cutLights(points, 800, 2, false, 1);
  for (const GaussianLight& light : lights) {
    EXPECT_GT(variance(light), 0);
    EXPECT_LT(variance(light), 0.05);
    const Vec3f n = light.normal;
    const float* c = light.covariance;
    const Vec3f q{c[0] * n.x + c[3] * n.y + c[4] * n.z, c[3] * n.x + c[1] * n.y + c[5] * n.z,
                  c[4] * n.x + c[5] * n.y + c[2] * n.z};
    EXPECT_NEAR(dot(n, q), 0, 1e-4 * variance(light));
  }
}

TEST(GaussianCut, NothingComesOfNothing) {
  EXPECT_TRUE(cutLights({}, 10, 1, false, 1).empty());
  const std::vector<LightPoint> dark(5);
  EXPECT_TRUE(cutLights(dark, 10, 1, false, 1).empty());
  EXPECT_TRUE(cutLights(pointsOf(20, 1), 0, 1, false, 1).empty());
}

TEST(GaussianCut, ThreadsDoNotMatter) {
  const std::vector<LightPoint> points = pointsOf(2000, 5);
  const auto lights = [&](int threads) {
    const ThreadLimit limit(threads);
    return cutLights(points, 100, 2, false, 7);
  };
  const std::vector<GaussianLight> one = lights(1), two = lights(2);
  ASSERT_EQ(one.size(), two.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].mean, two[i].mean);
    EXPECT_EQ(one[i].places[3].p, two[i].places[3].p);
  }
}

}  // namespace
}  // namespace lobelia::trees
