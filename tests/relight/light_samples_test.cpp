// Light samples are even: sums over them are integrals.
#include "lobelia/relight/light_samples.h"

#include <gtest/gtest.h>

#include <map>

#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

// Distances to the nearest other sample, over the square root of the measure.
std::vector<double> spacings(const LightSamples& samples) {
  std::vector<double> out;
  for (size_t i = 0; i < samples.count(); ++i) {
    float least = 1e30f;
    for (size_t j = 0; j < samples.count(); ++j)
      if (i != j) least = std::min(least, length(samples.p[i] - samples.p[j]));
    out.push_back(static_cast<double>(least / std::sqrt(samples.measure[i])));
  }
  return out;
}

TEST(EnvironmentSamples, AreUnitDirectionsOfTheWholeSphere) {
  const LightSamples samples = environmentSamples(1024, 7);
  ASSERT_EQ(samples.count(), 1024u);
  EXPECT_TRUE(samples.n.empty());
  double sum = 0;
  for (size_t i = 0; i < samples.count(); ++i) {
    EXPECT_NEAR(length(samples.p[i]), 1, 1e-5f);
    sum += double{samples.measure[i]};
  }
  EXPECT_NEAR(sum, 4 * 3.14159265358979, 1e-3);
}

TEST(EnvironmentSamples, IntegrateSmoothFunctions) {
  const LightSamples samples = environmentSamples(4096, 3);
  Rng rng(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3f axis = sampleSphereUniform(rng.next2D());
    const double sharpness = trial < 10 ? 2 : 40;
    double gaussian = 0, square = 0, cosine = 0;
    for (size_t i = 0; i < samples.count(); ++i) {
      const double c = double{dot(axis, samples.p[i])}, w = double{samples.measure[i]};
      gaussian += w * std::exp(sharpness * (c - 1));
      square += w * c * c;
      cosine += w * std::max(0.0, c);
    }
    const double exact = 2 * M_PI * (1 - std::exp(-2 * sharpness)) / sharpness;
    EXPECT_NEAR(gaussian / exact, 1, trial < 10 ? 5e-4 : 3e-3) << sharpness;
    EXPECT_NEAR(square, 4 * M_PI / 3, 2e-3);
    EXPECT_NEAR(cosine, M_PI, 1e-2);  // not smooth at the horizon
  }
}

// A triangular lattice has 1.0746; independent samples come as near as 0.01.
TEST(EnvironmentSamples, KeepApart) {
  std::vector<double> all = spacings(environmentSamples(2048, 1));
  std::sort(all.begin(), all.end());
  EXPECT_GT(all.front(), 0.65);
  EXPECT_GT(all[all.size() / 2], 0.85);
}

TEST(EnvironmentSamples, DependOnTheSeedAlone) {
  const LightSamples a = environmentSamples(512, 1), other = environmentSamples(512, 2);
  const ThreadLimit one(1);
  EXPECT_EQ(environmentSamples(512, 1).p, a.p);
  EXPECT_NE(other.p, a.p);
}

TEST(LightSamples, ArePowersOfTwo) {
  EXPECT_THROW(environmentSamples(1000, 0), std::invalid_argument);
  EXPECT_THROW(environmentSamples(1, 0), std::invalid_argument);
  EXPECT_THROW(environmentSamples(65536, 0), std::invalid_argument);
  EXPECT_NO_THROW(environmentSamples(2, 0));
}

TEST(SurfaceSamples, AreSpreadByArea) {
  const Scene scene = test::boxScene(false);  // six walls of area 4
  const LightSamples samples = surfaceSamples(scene, 1024, 4);
  ASSERT_EQ(samples.count(), 1024u);
  std::map<int, int> walls;
  double sum = 0, squares = 0;
  for (size_t i = 0; i < samples.count(); ++i) {
    const Vec3f p = samples.p[i], n = samples.n[i];
    EXPECT_NEAR(dot(p, n), -1, 1e-4f) << "on a wall, facing inwards";
    ++walls[static_cast<int>(std::lround(n.x + 2 * n.y + 4 * n.z))];
    sum += double{samples.measure[i]};
    squares += double{samples.measure[i] * lengthSquared(p)};
  }
  EXPECT_NEAR(sum, 24, 1e-3);
  EXPECT_NEAR(squares / 24, 1 + 2.0 / 3, 0.02);
  ASSERT_EQ(walls.size(), 6u);
  for (const auto& [wall, count] : walls) EXPECT_NEAR(count, 1024 / 6.0, 13) << wall;
}

TEST(SurfaceSamples, KeepApart) {
  std::vector<double> all = spacings(surfaceSamples(test::boxScene(false), 1024, 4));
  std::sort(all.begin(), all.end());
  EXPECT_GT(all[all.size() / 20], 0.5) << "corners, which look apart, left out";
  EXPECT_GT(all[all.size() / 2], 0.65);
}

TEST(SurfaceSamples, HaveBothSidesOfTwoSidedSurfaces) {
  Scene scene;
  test::place(scene, test::squareMesh()).material = test::addTwoSided(scene);
  const LightSamples samples = surfaceSamples(scene, 256, 1);
  int above = 0;
  for (const Vec3f n : samples.n) above += n.z > 0 ? 1 : 0;
  EXPECT_NEAR(above, 128, 25);
  EXPECT_NEAR(samples.measure[0] * 256, 2, 1e-4f);
}

TEST(SurfaceSamples, NeedASurface) { EXPECT_THROW(surfaceSamples(Scene(), 64, 1), InputError); }

}  // namespace
}  // namespace lobelia::relight
