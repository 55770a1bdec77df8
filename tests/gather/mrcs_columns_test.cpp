// The reduced matrix: against gatherAll() light by light; sketches against whole columns.
#include <gtest/gtest.h>

#include "gather/mrcs_input.h"
#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

TEST(MrcsRows, AreSpreadOverTheImageAndOverTheChosenPixels) {
  const RowPixels whole = chooseRowPixels(64, 48, {}, 300, 1);
  EXPECT_EQ(whole.rowCount, 300u);
  EXPECT_EQ(whole.checkCount, 64u);
  size_t perQuarter[4] = {};
  for (size_t i = 0; i < whole.pixels.pixels.size(); ++i) {
    EXPECT_NE(whole.row[i] == RowPixels::kNone, whole.check[i] == RowPixels::kNone);
    const uint32_t p = whole.pixels.pixels[i];
    if (whole.row[i] != RowPixels::kNone) ++perQuarter[(p % 64 >= 32) + 2 * (p / 64 >= 24)];
  }
  for (const size_t n : perQuarter) EXPECT_NEAR(static_cast<double>(n), 75, 15);

  PixelSet allowed;
  for (uint32_t p = 5; p < 3000; p += 3) allowed.pixels.push_back(p);
  const RowPixels among = chooseRowPixels(64, 48, allowed, 300, 1);
  EXPECT_EQ(among.rowCount, 300u);
  for (size_t i = 0; i < among.pixels.pixels.size(); ++i) {
    EXPECT_EQ(among.pixels.pixels[i] % 3, 2u);
    EXPECT_TRUE(i == 0 || among.pixels.pixels[i - 1] < among.pixels.pixels[i]);
  }
  // Fewer pixels than rows and checks: all of them, for both.
  const RowPixels few = chooseRowPixels(64, 48, allowed, 950, 1);
  EXPECT_EQ(few.pixels.pixels, allowed.pixels);
  EXPECT_EQ(few.row, few.check);
  EXPECT_EQ(few.rowCount, allowed.pixels.size());
}

class MrcsColumns : public testing::Test {
 protected:
  LightColumns columns(size_t dims, uint64_t seed = 1) {
    ColumnSettings settings;
    settings.gather = gather_;
    settings.dims = dims;
    settings.seed = seed;
    const LightNumbers numbers(lights_, gather_);
    return computeColumns(tracer_, rows_, lights_, numbers, settings, context_);
  }
  // A light's column by gatherAll() with that light alone.
  std::vector<double> column(const ChosenLight& light) {
    const VirtualLights one = chooseLights(lights_, {&light, 1});
    std::vector<Rgb> radiance(rows_.receivers.points.size());
    gatherAll(tracer_, rows_.receivers, one, gather_, radiance, context_);
    std::vector<double> out(3 * rows_.rowCount, 0.0);
    for (size_t i = 0; i < radiance.size(); ++i)
      for (int c = 0; c < 3 && rows_.row[i] != RowPixels::kNone; ++c)
        out[3 * rows_.row[i] + static_cast<size_t>(c)] += double{radiance[i][c]};
    return out;
  }

  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  VirtualLights lights_ = randomLights(50, 200.f, 5);
  // Two points in some pixels.
  Receivers receivers_ = [] {
    Receivers r = randomReceivers(600, {LobeType::lambert, LobeType::phong}, 2, 3);
    for (ReceiverPoint& point : r.points) point.pixel = point.pixel * 2 / 3;
    return r;
  }();
  Rows rows_ = rowsOf(receivers_, 20, 20, 100, 4);
  GatherSettings gather_ = [] {
    GatherSettings settings;
    settings.direct = true;
    settings.maxDepth = 5;
    return settings;
  }();
};

TEST_F(MrcsColumns, AreWhatEachLightAddsToTheRows) {
  const LightColumns whole = columns(0);
  const LightNumbers numbers(lights_, gather_);
  ASSERT_EQ(whole.count, numbers.count());
  ASSERT_GT(whole.count, 150u);
  AlignedFloats vector(whole.stride());
  std::vector<double> total(3 * rows_.rowCount, 0.0);
  double hardlySeen = 0, hardlySeenCount = 0;
  for (size_t i = 0; i < whole.count; ++i) {
    const std::vector<double> expected = column(numbers.at(i));
    whole.load(i, vector.data());
    double squared = 0;
    int seen = 0;
    for (size_t r = 0; r < expected.size(); r += 3) {
      double row = 0;
      for (size_t c = r; c < r + 3; ++c) {
        EXPECT_NEAR(double{vector[c]} * double{whole.weight[i]}, expected[c],
                    1e-4 * expected[c] + 1e-6 * double{whole.weight[i]});
        total[c] += expected[c];
        row += expected[c] * expected[c];
      }
      squared += row;
      seen += row > 0;
    }
    if (seen <= 1) hardlySeen += std::sqrt(squared), ++hardlySeenCount;
    EXPECT_NEAR(double{whole.weight[i]}, std::sqrt(squared + whole.unseen),
                1e-5 * double{whole.weight[i]});
  }
  ASSERT_GT(hardlySeen, 0);
  EXPECT_NEAR(std::sqrt(whole.unseen), kUnseenShare * hardlySeen / hardlySeenCount,
              1e-4 * std::sqrt(whole.unseen));
  double norm = 0;
  for (const double x : total) norm += x * x;
  EXPECT_NEAR(whole.rowNorm, std::sqrt(norm), 1e-4 * whole.rowNorm);
}

// In the mean over the signs; the deviation of one sketch's squared distances is sqrt(2/d) at most
// for distances spread over many rows.
TEST_F(MrcsColumns, SketchesKeepDistances) {
  const LightColumns whole = columns(0);
  const auto distance = [](const LightColumns& c, size_t i, size_t k) {
    AlignedFloats a(c.stride()), b(c.stride());
    c.load(i, a.data());
    c.load(k, b.data());
    double sum = 0;
    for (size_t d = 0; d < c.dims; ++d) sum += std::pow(double{a[d]} - double{b[d]}, 2);
    return sum;
  };
  constexpr int kSeeds = 60;
  std::vector<std::vector<double>> ratios(whole.count / 2);
  for (int seed = 0; seed < kSeeds; ++seed) {
    const LightColumns sketch = columns(64, static_cast<uint64_t>(seed));
    EXPECT_EQ(sketch.bytes(), sketch.count * (2 * (64 + 16) + 8));
    for (size_t i = 0; i < ratios.size(); ++i) {
      const double exact = distance(whole, 2 * i, 2 * i + 1);
      if (exact > 1e-3) ratios[i].push_back(distance(sketch, 2 * i, 2 * i + 1) / exact);
    }
  }
  double sum = 0, squares = 0, n = 0;
  for (const auto& ratio : ratios)
    for (const double r : ratio) sum += r, squares += (r - 1) * (r - 1), ++n;
  ASSERT_GT(n, 50 * kSeeds);
  const double deviation = std::sqrt(squares / n);
  EXPECT_LT(deviation, std::sqrt(2.0 / 64) * 1.1);
  // Pairs of one seed share its signs.
  EXPECT_NEAR(sum / n, 1, 4 * deviation / std::sqrt(kSeeds));
}

// Clusters made from a sketch look better in it than they are, as they fit its signs, too; check
// rows' sketches, which they were not made from, tell the truth in the mean.
TEST_F(MrcsColumns, CostsFromSketchesAreNearThoseFromWholeColumns) {
  const LightColumns whole = columns(0);
  constexpr int kSeeds = 40;
  double rows = 0, checks = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const LightColumns sketch = columns(64, static_cast<uint64_t>(seed));
    ClusterSettings settings;
    settings.count = 25;
    const Clustering clustering = clusterLights(sketch, settings, context_);
    double wholeRows = 0, wholeChecks = 0;
    for (const LightCluster& cluster : clustering.clusters) {
      const LightCluster exact =
          measureCluster(whole, clustering.order, cluster.begin, cluster.end);
      wholeRows += exact.rowCost, wholeChecks += exact.checkCost;
    }
    rows += clustering.rowCost / wholeRows / kSeeds;
    checks += clustering.checkCost / wholeChecks / kSeeds;
  }
  RecordProperty("rows", std::to_string(rows));
  RecordProperty("checks", std::to_string(checks));
  EXPECT_LT(rows, 1.05);
  EXPECT_GT(rows, 0.6);
  EXPECT_NEAR(checks, 1, 0.1);
}

TEST_F(MrcsColumns, SameBitsForAnyNumberOfThreads) {
  std::vector<LightColumns> results;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    results.push_back(columns(32));
  }
  for (size_t i = 1; i < results.size(); ++i) {
    EXPECT_EQ(results[i].halves, results[0].halves);
    EXPECT_EQ(results[i].weight, results[0].weight);
    EXPECT_EQ(results[i].scale, results[0].scale);
    EXPECT_EQ(results[i].unseen, results[0].unseen);
    EXPECT_EQ(results[i].rowNorm, results[0].rowNorm);
    EXPECT_EQ(results[i].checkNorm, results[0].checkNorm);
  }
}

// A weight of 0 would make a light's column, over its weight, no number, and the clustering stop.
TEST(MrcsUnseen, LeavesNoLightWithoutWeight) {
  for (const double length : {1e-45, 1e-38, 1e-20, 1.0}) {
    const double unseen = squaredUnseen(3 * length, 5, static_cast<float>(length));
    EXPECT_GT(static_cast<float>(std::sqrt(unseen)), 0) << length;
    EXPECT_LE(std::sqrt(unseen), std::max(length, 1e-30)) << length;
  }
  EXPECT_GT(squaredUnseen(0, 0, kNoneSeen), 0) << "all are seen, if only by so little";
  EXPECT_EQ(squaredUnseen(0, 5, kNoneSeen), 1) << "none is seen: all alike";
}

}  // namespace
}  // namespace lobelia
