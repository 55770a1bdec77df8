#include "lobelia/lights/cluster_sums.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

// Points within `extent` of a place.
std::vector<LightPoint> somePoints(size_t count, Vec3f at = {}, float extent = 1) {
  Rng random(11);
  std::vector<LightPoint> points(count);
  for (LightPoint& p : points) {
    const auto colour = [&] { return Rgb(random.next1D(), random.next1D(), random.next1D()); };
    p.p = at + (colour() - Rgb(0.5f)) * (2 * extent);
    p.n = sampleSphereUniform(random.next2D());
    p.axis = sampleSphereUniform(random.next2D());
    p.diffuse = colour();
    p.glossy = colour() * 3.f;
    p.sharpness = std::exp(8 * random.next1D());
  }
  return points;
}

std::vector<uint32_t> all(const std::vector<LightPoint>& points) {
  std::vector<uint32_t> members(points.size());
  std::iota(members.begin(), members.end(), 0u);
  return members;
}

void expectNear(Vec3f a, Vec3f b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

TEST(ClusterSums, OnePointComesBack) {
  for (const bool toksvig : {false, true}) {
    for (const float sharpness : {0.01f, 0.5f, 2.f, 30.f, 1e4f, 1e6f}) {
      LightPoint point = somePoints(1, {1000, -300, 20}, 3)[0];
      point.sharpness = sharpness;
      point.group = 4, point.depth = 2;
      const uint32_t members[] = {0};
      const GaussianLight light = clusterLight({&point, 1}, members, toksvig, 5);
      EXPECT_EQ(light.mean, point.p);
      for (const float c : light.covariance) EXPECT_EQ(c, 0.f);
      EXPECT_EQ(light.diffuse, point.diffuse);
      EXPECT_EQ(light.glossy, point.glossy);
      expectNear(light.normal, point.n, 3e-7f);
      EXPECT_EQ(light.normalSharpness, 1e7f);
      expectNear(light.axis, point.axis, 3e-7f);
      EXPECT_NEAR(light.sharpness, sharpness, 2e-6f * sharpness);
      EXPECT_EQ(light.group, 4);
      EXPECT_EQ(light.depth, 2);
      for (const GaussianLight::Place& place : light.places) {
        EXPECT_EQ(place.p, point.p);
        EXPECT_EQ(place.normal, encodeOctahedral(point.n));
      }
      const GaussianLight summed = ClusterSums::of(point, toksvig).light(toksvig);
      expectNear(summed.mean, point.p, 1e-4f);
      for (const float c : summed.covariance) EXPECT_EQ(c, 0.f);
      EXPECT_NEAR(summed.sharpness, sharpness, 2e-6f * sharpness);
    }
  }
}

// What is without a part has no lobe of it, and a side nevertheless.
TEST(ClusterSums, PartsThatAreMissing) {
  LightPoint point = somePoints(1)[0];
  point.diffuse = {};
  GaussianLight light = ClusterSums::of(point, false).light(false);
  EXPECT_EQ(light.diffuse, Rgb());
  expectNear(light.normal, point.n, 3e-7f);
  EXPECT_EQ(light.normalSharpness, 1e7f);
  point = somePoints(1)[0];
  point.glossy = {};
  light = ClusterSums::of(point, false).light(false);
  EXPECT_EQ(light.glossy, Rgb());
  EXPECT_EQ(light.sharpness, 0.f);
}

// Against sums written down one by one, also where the cluster is small and far from the origin.
TEST(ClusterSums, MomentsAreThoseOfThePoints) {
  for (const auto& [at, extent] :
       {std::pair(Vec3f{0.5f, -1, 2}, 2.f), std::pair(Vec3f{9000, -8000, 7000}, 0.2f)}) {
    const std::vector<LightPoint> points = somePoints(300, at, extent);
    const GaussianLight light = clusterLight(points, all(points), false, 1);
    double weight = 0, diffuseWeight = 0, glossyWeight = 0, mean[3] = {}, square[6] = {};
    Vec3d normal, axis, side;
    for (const LightPoint& p : points) {
      const double d = double{luminance(p.diffuse)}, g = double{luminance(p.glossy)};
      weight += d + g, diffuseWeight += d, glossyWeight += g;
      for (int i = 0; i < 3; ++i) {
        mean[i] += (d + g) * double{p.p[i]};
        normal[i] += d * double{p.n[i]};
        side[i] += (d + g) * double{p.n[i]};
        axis[i] += g * double{p.axis[i]} * double{lobes::meanResultant(p.sharpness)};
      }
    }
    for (double& m : mean) m /= weight;
    const int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
    for (const LightPoint& p : points)
      for (int i = 0; i < 6; ++i)
        square[i] += double{p.power()} * (double{p.p[row[i]]} - mean[row[i]]) *
                     (double{p.p[column[i]]} - mean[column[i]]) / weight;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(double{light.mean[i]}, mean[i], 1e-7 * std::abs(mean[i]) + 1e-6);
      EXPECT_NEAR(double{light.normal[i]}, normal[i] / length(normal), 1e-4);
      EXPECT_NEAR(double{light.axis[i]}, axis[i] / length(axis), 1e-4);
    }
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(double{light.covariance[i]}, square[i], 1e-5 * square[i % 3]);
    // Sides of all power, where these spread more than those of diffuse power.
    EXPECT_NEAR(double{lobes::meanResultant(light.normalSharpness)},
                std::min(length(normal) / diffuseWeight, length(side) / weight), 1e-5);
    EXPECT_NEAR(double{lobes::meanResultant(light.sharpness)}, length(axis) / glossyWeight, 1e-5);
  }
}

TEST(ClusterSums, HalvesMakeTheWhole) {
  const std::vector<LightPoint> points = somePoints(500);
  ClusterSums whole, left, right;
  for (size_t i = 0; i < points.size(); ++i) {
    const ClusterSums one = ClusterSums::of(points[i], false);
    whole += one;
    (i < 150 ? left : right) += one;
  }
  left += right;
  left *= 3;
  const GaussianLight a = whole.light(false), b = left.light(false);
  const GaussianLight direct = clusterLight(points, all(points), false, 1);
  for (const GaussianLight& light : {b, direct}) {
    expectNear(light.mean, a.mean, 1e-6f);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(light.covariance[i], a.covariance[i], 1e-6f);
    expectNear(light.normal, a.normal, 1e-5f);
    EXPECT_NEAR(light.normalSharpness, a.normalSharpness, 1e-5f);
    expectNear(light.axis, a.axis, 1e-5f);
    EXPECT_NEAR(light.sharpness, a.sharpness, 1e-5f);
  }
  expectNear(b.diffuse, a.diffuse * 3.f, 1e-3f);
  expectNear(b.glossy, a.glossy * 3.f, 1e-3f);
  expectNear(direct.diffuse, a.diffuse, 1e-4f);
  expectNear(direct.glossy, a.glossy, 1e-4f);
}

// Merging of lobes: exact means are those of lobes::lobeOf(); the paper's pair differs where lobes
// are broad, and only there.
TEST(ClusterSums, MeansByToksvig) {
  const auto merged = [](float sharpness, float cosine, bool toksvig) {
    std::vector<LightPoint> points = somePoints(2);
    for (LightPoint& p : points) p.sharpness = sharpness, p.glossy = Rgb(1);
    points[0].axis = {0, 0, 1};
    points[1].axis = {std::sqrt(1 - cosine * cosine), 0, cosine};
    return clusterLight(points, all(points), toksvig, 1).sharpness;
  };
  const auto reference = [](float sharpness, float cosine) {
    lobes::Moment moment = lobes::momentOf({0, 0, 1}, sharpness, 1);
    moment.add(lobes::momentOf({std::sqrt(1 - cosine * cosine), 0, cosine}, sharpness, 1));
    return lobes::lobeOf(moment).sharpness;
  };
  for (const float sharpness : {0.5f, 2.f, 10.f, 500.f})
    EXPECT_NEAR(merged(sharpness, 0.7f, false) / reference(sharpness, 0.7f), 1, 1e-4f);
  EXPECT_NEAR(merged(3, 0.5f, true), 1.8532f, 1e-4f) << "r = 3/4 cos 30 deg; r / (1 - r)";
  EXPECT_GT(std::abs(merged(1, 0, true) / merged(1, 0, false) - 1), 0.05f);
  EXPECT_NEAR(merged(500, 0.999f, true) / merged(500, 0.999f, false), 1, 0.01f);
}

TEST(ClusterSums, PlacesAreDrawnByPower) {
  std::vector<LightPoint> points = somePoints(5);
  const float powers[] = {1, 0, 2, 4, 1};
  Vec3f mean;
  for (size_t i = 0; i < 5; ++i) {
    points[i].glossy = {}, points[i].diffuse = Rgb(powers[i]);
    mean += points[i].p * (powers[i] / 8);
  }
  std::map<float, double> counts;  // by x, which tells points apart
  constexpr int kSeeds = 20000;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const GaussianLight light = clusterLight(points, all(points), false, seed);
    for (const LightPoint& p : points)
      if (p.power() > 0) {
        EXPECT_LE(length(light.places[0].p - mean), length(p.p - mean) + 1e-6f);
      }
    for (int k = 1; k < GaussianLight::kPlaces; ++k) counts[light.places[k].p.x] += 1;
  }
  for (size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(counts[points[i].p.x] / (3 * kSeeds), double{powers[i]} / 8, 0.01) << i;
}

TEST(ClusterSums, ClustersTakeTheirMembers) {
  const std::vector<LightPoint> points = somePoints(100);
  Clusters clusters;
  clusters.order = {5, 7, 9, 1, 99};
  clusters.ends = {3, 5};
  const ThreadLimit limit(2);
  const std::vector<GaussianLight> lights = clusterLights(points, clusters, false, 3);
  ASSERT_EQ(lights.size(), 2u);
  expectNear(lights[0].diffuse, points[5].diffuse + points[7].diffuse + points[9].diffuse, 1e-6f);
  expectNear(lights[1].diffuse, points[1].diffuse + points[99].diffuse, 1e-6f);
}

}  // namespace
}  // namespace lobelia
