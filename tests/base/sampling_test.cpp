#include "lobelia/base/sampling.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/chi_squared.h"
#include "lobelia/base/random.h"

namespace lobelia {
namespace {

constexpr int kSamples = 1 << 18;

double aliasPValue(const std::vector<float>& weights) {
  const AliasTable table(weights);
  std::vector<double> counts(weights.size()), expected(weights.size());
  for (size_t i = 0; i < weights.size(); ++i) {
    expected[i] = static_cast<double>(table.probability(i)) * kSamples;
  }
  Rng rng(17);
  for (int i = 0; i < kSamples; ++i) counts[table.sample(rng.next1D())] += 1;
  return test::chiSquaredPValue(counts, expected);
}

TEST(AliasTable, FollowsItsWeights) {
  EXPECT_GT(aliasPValue({1, 2, 3, 4}), 1e-3);
  EXPECT_GT(aliasPValue({0, 1e-3f, 0, 5, 0.1f, 0}), 1e-3);
  std::vector<float> many(1000);
  Rng rng(2);
  for (float& w : many) w = std::pow(rng.next1D(), 8.f);
  EXPECT_GT(aliasPValue(many), 1e-3);
}

TEST(AliasTable, ProbabilitiesAreShares) {
  const std::vector<float> weights{1, 0, 3};
  const AliasTable table(weights);
  EXPECT_EQ(table.total(), 4);
  EXPECT_FLOAT_EQ(table.probability(0), 0.25f);
  EXPECT_EQ(table.probability(1), 0.f);
  EXPECT_FLOAT_EQ(table.probability(2), 0.75f);
}

TEST(AliasTable, EmptyWithoutWeight) {
  const std::vector<float> weights(3, 0.f);
  EXPECT_EQ(AliasTable(weights).total(), 0);
  EXPECT_EQ(AliasTable(weights).probability(1), 0.f);
  EXPECT_EQ(AliasTable().total(), 0);
}

TEST(AliasTable, RemappedNumberIsUniformForEveryItem) {
  const std::vector<float> weights{1, 2, 10, 0.5f};
  const AliasTable table(weights);
  std::vector<double> counts(4 * 16), expected(4 * 16);
  Rng rng(4);
  for (int i = 0; i < kSamples; ++i) {
    float v = -1;
    const size_t item = table.sample(rng.next1D(), &v);
    ASSERT_GE(v, 0.f);
    ASSERT_LT(v, 1.f);
    counts[item * 16 + static_cast<size_t>(v * 16)] += 1;
  }
  for (size_t i = 0; i < expected.size(); ++i) {
    expected[i] = static_cast<double>(table.probability(i / 16)) / 16 * kSamples;
  }
  EXPECT_GT(test::chiSquaredPValue(counts, expected), 1e-3);
}

// A million bins leave few of the 24 bits of u for the choice inside a bin: a heavy item must get
// its share all the same.
TEST(AliasTable, HeavyItemAmongAMillion) {
  std::vector<float> weights(1 << 20, 1.f);
  weights[12345] = 1e7f;
  const AliasTable table(weights);
  double hits = 0;
  Rng rng(8);
  for (int i = 0; i < kSamples; ++i) hits += table.sample(rng.next1D()) == 12345 ? 1 : 0;
  const double p = 1e7 / (1e7 + (1 << 20) - 1);
  EXPECT_NEAR(hits / kSamples, p, 4 * std::sqrt(p * (1 - p) / kSamples));
}

TEST(Distribution2D, FollowsItsWeights) {
  constexpr int kWidth = 13, kHeight = 7;
  std::vector<float> weights(kWidth * kHeight);
  Rng rng(9);
  for (float& w : weights) w = rng.next1D() < 0.3f ? 0.f : std::pow(rng.next1D(), 4.f);
  for (size_t x = 0; x < kWidth; ++x) weights[3 * kWidth + x] = 0;  // a dark row
  const Distribution2D distribution(weights, kWidth, kHeight);
  std::vector<double> counts(weights.size()), expected(weights.size());
  for (size_t i = 0; i < weights.size(); ++i) {
    expected[i] = static_cast<double>(weights[i]) / distribution.total() * kSamples;
  }
  for (int i = 0; i < kSamples; ++i) {
    float pdf = 0;
    const Vec2f p = distribution.sample(rng.next2D(), &pdf);
    ASSERT_LT(p.x, 1.f);
    ASSERT_LT(p.y, 1.f);
    ASSERT_GT(pdf, 0.f);
    const auto x = static_cast<size_t>(p.x * kWidth), y = static_cast<size_t>(p.y * kHeight);
    counts[y * kWidth + x] += 1;
  }
  EXPECT_GT(test::chiSquaredPValue(counts, expected), 1e-3);
}

TEST(Distribution2D, DensityIntegratesToOneAndAgreesWithSampling) {
  const std::vector<float> weights{1, 2, 0, 4, 0.5f, 3};
  const Distribution2D distribution(weights, 3, 2);
  double sum = 0;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      const Vec2f centre{(static_cast<float>(x) + 0.5f) / 3, (static_cast<float>(y) + 0.5f) / 2};
      sum += static_cast<double>(distribution.pdf(centre)) / 6;
    }
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  // Cell centres come from known numbers: no rounding decides the cell.
  float pdf = 0;
  const Vec2f p = distribution.sample({0.5f, 0.1f}, &pdf);
  EXPECT_FLOAT_EQ(pdf, distribution.pdf(p));
}

// The search of many side by side, in a tree of three levels.
TEST(Distribution2D, PrefetchFindsTheCellsOfSamples) {
  constexpr int kWidth = 400, kHeight = 5;
  std::vector<float> weights(kWidth * kHeight);
  Rng rng(19);
  for (float& w : weights) w = rng.next1D() < 0.3f ? 0.f : rng.next1D();
  const Distribution2D distribution(weights, kWidth, kHeight);
  std::vector<Vec2f> numbers(500);
  for (Vec2f& u : numbers) u = rng.next2D();
  std::vector<size_t> cells(numbers.size());
  distribution.prefetch(numbers, cells);
  size_t same = 0;
  for (size_t i = 0; i < numbers.size(); ++i) {
    const Vec2f p = distribution.sample(numbers[i], nullptr);
    const auto x = static_cast<size_t>(p.x * kWidth), y = static_cast<size_t>(p.y * kHeight);
    same += cells[i] == y * kWidth + x ? 1 : 0;
  }
  EXPECT_GE(same, numbers.size() - 2);  // rounding may move a place to a neighbour
}

TEST(Distribution2D, KeepsStrata) {
  std::vector<float> weights(32 * 16);
  Rng rng(10);
  for (float& w : weights) w = rng.next1D();
  const Distribution2D distribution(weights, 32, 16);
  // Stratified input: the number of points in a row differs from its expectation by at most one
  // stratum at each end.
  constexpr int kCount = 1024;
  std::vector<double> rows(16), expected(16);
  for (uint32_t i = 0; i < kCount; ++i) {
    float pdf = 0;
    const Vec2f p = distribution.sample(Sampler(1, 2, i).next2D(), &pdf);
    rows[static_cast<size_t>(p.y * 16)] += 1;
  }
  for (size_t y = 0; y < 16; ++y) {
    for (size_t x = 0; x < 32; ++x) expected[y] += static_cast<double>(weights[y * 32 + x]);
    EXPECT_NEAR(rows[y], expected[y] / distribution.total() * kCount, 2) << y;
  }
}

TEST(Distribution2D, EmptyWithoutWeight) {
  const std::vector<float> weights(6, 0.f);
  const Distribution2D distribution(weights, 3, 2);
  float pdf = 1;
  distribution.sample({0.5f, 0.5f}, &pdf);
  EXPECT_EQ(pdf, 0.f);
  EXPECT_EQ(distribution.pdf({0.5f, 0.5f}), 0.f);
}

// Equal-area warps: counts in the cells of the inverse map are uniform; the means are analytic.
TEST(Sampling, WarpsHaveTheirDensities) {
  Rng rng(12);
  std::vector<double> height(20), cosine(20), cone(20), flat(20, kSamples / 20.0);
  double disk = 0;
  Vec2f triangle{};
  const float narrow = 1e-5f;
  for (int i = 0; i < kSamples; ++i) {
    const Vec2f u = rng.next2D();
    const Vec3f s = sampleSphereUniform(u), c = sampleHemisphereCosine(u);
    ASSERT_NEAR(length(s), 1, 1e-5f);
    ASSERT_NEAR(length(c), 1, 1e-5f);
    ASSERT_GE(c.z, 0.f);
    height[std::min<size_t>(19, static_cast<size_t>((s.z + 1) * 10))] += 1;
    cosine[std::min<size_t>(19, static_cast<size_t>(c.z * c.z * 20))] += 1;  // cos^2 is uniform
    const Vec3f n = sampleConeUniform(u, narrow);
    // sin^2 = t (2 - t) ~ 2 t: exact where 1 - cos has lost its bits.
    const float t = (n.x * n.x + n.y * n.y) / (2 * narrow);
    cone[std::min<size_t>(19, static_cast<size_t>(t * 20))] += 1;
    const Vec2f d = sampleDiskConcentric(u);
    ASSERT_LE(d.x * d.x + d.y * d.y, 1.00001f);
    disk += static_cast<double>(d.x * d.x + d.y * d.y);
    const Vec2f b = sampleTriangleUniform(u);
    ASSERT_GE(b.x, 0.f);
    ASSERT_LE(b.x + b.y, 1.00001f);
    triangle = triangle + b;
  }
  EXPECT_GT(test::chiSquaredPValue(height, flat), 1e-3);
  EXPECT_GT(test::chiSquaredPValue(cosine, flat), 1e-3);
  EXPECT_GT(test::chiSquaredPValue(cone, flat), 1e-3);
  EXPECT_NEAR(disk / kSamples, 0.5, 0.005);
  EXPECT_NEAR(triangle.x / kSamples, 1.f / 3, 0.005f);
  EXPECT_NEAR(triangle.y / kSamples, 1.f / 3, 0.005f);
}

TEST(Sampling, PowerHeuristicSumsToOneAndSurvivesSharpLobes) {
  EXPECT_FLOAT_EQ(powerHeuristic(2, 3) + powerHeuristic(3, 2), 1.f);
  EXPECT_EQ(powerHeuristic(0, 1), 0.f);
  EXPECT_EQ(powerHeuristic(1e30f, 1), 1.f);
}

}  // namespace
}  // namespace lobelia
