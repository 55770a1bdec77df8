#include "lobelia/path/emitter_tree.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/chi_squared.h"
#include "lobelia/base/random.h"

namespace lobelia {
namespace {

Vec3f direction(Rng& random) {
  for (;;) {
    const Vec2f a = random.next2D();
    const Vec3f v{2 * a.x - 1, 2 * a.y - 1, 2 * random.next1D() - 1};
    const float len2 = lengthSquared(v);
    if (len2 > 1e-4f && len2 < 1) return v / std::sqrt(len2);
  }
}
Vec3f point(Rng& random, float size) {
  const Vec2f a = random.next2D();
  return Vec3f{a.x - 0.5f, a.y - 0.5f, random.next1D() - 0.5f} * (2 * size);
}

// Small one-sided patches, omni lights and spots; every tenth without intensity.
std::vector<TreeLight> randomLights(size_t count, uint64_t seed) {
  Rng random(seed);
  std::vector<TreeLight> lights(count);
  for (size_t i = 0; i < count; ++i) {
    TreeLight& light = lights[i];
    const Vec3f centre = point(random, 10);
    light.bounds.add(centre);
    light.axis = direction(random);
    if (i % 3 == 0) light.bounds.add(centre + point(random, 0.2f));
    if (i % 3 == 1) light.cosThetaO = -1;
    if (i % 3 == 2) light.cosThetaO = 0.8f, light.cosThetaE = 0.9f;
    light.intensity = i % 10 == 9 ? 0.f : 0.1f + random.next1D();
  }
  return lights;
}

TEST(EmitterTree, ProbabilityEqualsTheExhaustiveTwin) {
  const auto lights = randomLights(700, 1);
  const EmitterTree tree(lights);
  Rng random(2);
  for (int i = 0; i < 30; ++i) {
    const Vec3f p = point(random, 15), n = i % 3 == 0 ? Vec3f{} : direction(random);
    const std::vector<float> all = tree.probabilities(p, n);
    double sum = 0;
    for (uint32_t l = 0; l < lights.size(); ++l) {
      EXPECT_FLOAT_EQ(tree.probability(p, n, l), all[l]);
      if (lights[l].intensity == 0) {
        EXPECT_EQ(all[l], 0.f);
      }
      sum += static_cast<double>(all[l]);
    }
    EXPECT_LE(sum, 1 + 1e-5);
  }
}

TEST(EmitterTree, OmniLightsAreAlwaysReached) {
  auto lights = randomLights(300, 3);
  for (TreeLight& light : lights) light.cosThetaO = -1, light.intensity = 1;
  const EmitterTree tree(lights);
  Rng random(4);
  for (int i = 0; i < 20; ++i) {
    const auto all = tree.probabilities(point(random, 15), {});
    EXPECT_NEAR(std::accumulate(all.begin(), all.end(), 0.0), 1, 1e-5);
    EXPECT_GT(*std::min_element(all.begin(), all.end()), 0.f);
  }
}

TEST(EmitterTree, SamplesFollowTheProbabilities) {
  const auto lights = randomLights(150, 5);
  const EmitterTree tree(lights);
  Rng random(6);
  for (int i = 0; i < 5; ++i) {
    const Vec3f p = point(random, 12), n = i == 0 ? Vec3f{} : direction(random);
    std::vector<double> observed(lights.size() + 1), expected(lights.size() + 1);
    constexpr int kSamples = 40000;
    for (int s = 0; s < kSamples; ++s) {
      const auto choice = tree.sample(p, n, static_cast<double>(random.next1D()));
      if (!choice) {
        observed.back() += 1;
        continue;
      }
      observed[choice->light] += 1;
      ASSERT_FLOAT_EQ(choice->probability, tree.probability(p, n, choice->light));
    }
    double left = 1;
    for (uint32_t l = 0; l < lights.size(); ++l) {
      const double q = static_cast<double>(tree.probability(p, n, l));
      expected[l] = kSamples * q;
      left -= q;
    }
    expected.back() = left > 1e-5 ? kSamples * left : 0;
    EXPECT_GT(test::chiSquaredPValue(observed, expected), 0.01 / 5);
  }
}

// The tree is there to be better than a choice by intensity alone: what it gives a light should
// follow what the light sends.
TEST(EmitterTree, NearLightsArePreferred) {
  std::vector<TreeLight> lights(1000);
  for (size_t i = 0; i < lights.size(); ++i) {
    lights[i].bounds.add({static_cast<float>(i), 0, 0});
    lights[i].cosThetaO = -1;
    lights[i].intensity = 1;
  }
  const EmitterTree tree(lights);
  const Vec3f p{500, 1, 0};
  // Exact share of light 500: 1 / sum over i of 1 / (1 + (i - 500)^2), about 1 / (pi coth pi).
  EXPECT_GT(tree.probability(p, {}, 500), 0.4f / 3.15f);
  EXPECT_LT(tree.probability(p, {}, 10), 0.2f / 1000);
}

TEST(EmitterTree, LightsBehindTheSurfaceOrShiningAwayGetNothing) {
  std::vector<TreeLight> lights(4);
  for (size_t i = 0; i < 4; ++i) {
    const float x = static_cast<float>(i);
    lights[i].bounds.add({x, 0, i < 2 ? 5.f : -5.f});
    lights[i].bounds.add({x + 0.1f, 0.1f, i < 2 ? 5.f : -5.f});
    lights[i].axis = {0, 0, i % 2 == 0 ? -1.f : 1.f};
    lights[i].intensity = 1;
  }
  const EmitterTree tree(lights);
  const auto all = tree.probabilities({}, {0, 0, 1});
  EXPECT_NEAR(all[0], 1, 1e-6);  // in front and shining here
  EXPECT_EQ(all[1], 0);
  EXPECT_EQ(all[2], 0);
  EXPECT_EQ(all[3], 0);
}

TEST(EmitterTree, TakesCoincidentManyAndNoLights) {
  EXPECT_TRUE(EmitterTree{}.empty());
  EXPECT_TRUE(EmitterTree(std::vector<TreeLight>(3)).empty());
  std::vector<TreeLight> same(5000);
  for (TreeLight& light : same)
    light.bounds.add({1, 2, 3}), light.intensity = 1, light.cosThetaO = -1;
  const EmitterTree coincident(same);
  EXPECT_NEAR(coincident.probability({}, {}, 17), 1 / 5000.f, 1e-7f);
  // Sizes in geometric progression make the most unbalanced splits.
  std::vector<TreeLight> spread(30000);
  for (size_t i = 0; i < spread.size(); ++i) {
    const double x = std::pow(1.0005, static_cast<double>(i));
    spread[i].bounds.add({static_cast<float>(x), 0, 0});
    spread[i].intensity = static_cast<float>(x * x);
    spread[i].cosThetaO = -1;
  }
  const EmitterTree unbalanced(spread);
  const auto all = unbalanced.probabilities({}, {});
  EXPECT_NEAR(std::accumulate(all.begin(), all.end(), 0.0), 1, 1e-4);
  for (uint32_t l = 0; l < spread.size(); l += 1001) {
    EXPECT_FLOAT_EQ(unbalanced.probability({}, {}, l), all[l]);
  }
}

}  // namespace
}  // namespace lobelia
