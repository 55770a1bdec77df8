// LightSlice against the sum over all lights.
#include "lobelia/gather/light_slices.h"

#include "gather/mrcs_input.h"
#include "gather/strategy_test.h"
#include "lobelia/base/error.h"
#include "lobelia/gather/slice_clusters.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class LightSlice : public StrategyTest {
 protected:
  LightSlice() {
    settings_.slices = 12;
    settings_.columns = 100;
    settings_.rows = 5;
  }
  std::unique_ptr<PreparedGather> prepare(uint64_t seed) override {
    settings_.gather = gather_;
    settings_.seed = seed;
    return std::make_unique<LightSlices>(tracer_, receivers_, lights_, settings_, context_);
  }
  SliceSettings settings_;
};

TEST_F(LightSlice, EveryReceiverHasASliceOfPointsLikeIt) {
  const ReceiverSlices slices(receivers_, 20, 2, 1);
  ASSERT_EQ(slices.count(), 20u);
  std::vector<std::vector<size_t>> members(20);
  for (size_t i = 0; i < receivers_.points.size(); ++i)
    members[slices.sliceOf(receivers_.points[i])].push_back(i);
  double inside = 0, overall = 0;  // squared distances of normals and places, as slices see them
  const auto apart = [&](size_t a, size_t b) {
    const ReceiverPoint &x = receivers_.points[a], &y = receivers_.points[b];
    return double{lengthSquared((x.p - y.p) / 0.1f)} + double{lengthSquared(x.frame.n - y.frame.n)};
  };
  for (size_t s = 0; s < 20; ++s) {
    ASSERT_FALSE(members[s].empty()) << s;
    EXPECT_EQ(slices.sliceOf(receivers_.points[slices.representative(s)]), s);
    for (const size_t i : members[s]) {
      inside += apart(i, members[s][i % members[s].size()]) / 300;
      overall += apart(i, (i * 7 + 1) % 300) / 300;
    }
  }
  EXPECT_LT(inside, 0.5 * overall);
  const auto near = slices.neighbours(3, 6);
  ASSERT_EQ(near.size(), 6u);
  EXPECT_EQ(near[0].slice, 3u);
  for (size_t i = 1; i < near.size(); ++i)
    EXPECT_GE(near[i].squaredDistance, near[i - 1].squaredDistance);
}

TEST_F(LightSlice, AlikeReceiversAreFewSlices) {
  for (ReceiverPoint& point : receivers_.points) {
    point.p = {point.pixel < 150 ? 0.5f : -0.5f, 0, 0};
    point.frame = frameFromNormal({0, 0, 1});
  }
  const ReceiverSlices slices(receivers_, 20, 2, 1);
  EXPECT_EQ(slices.count(), 2u);
  EXPECT_NE(slices.sliceOf(receivers_.points[0]), slices.sliceOf(receivers_.points[200]));
}

// A slice's lengths and unseen parts, worked out anew.
TEST_F(LightSlice, ColumnsOfSomeRows) {
  const LightColumns all = columnsFrom(scatteredVectors(40, 48, 5, 2), 0);
  const RowFactor rows[] = {{7, 1.f}, {2, 0.5f}};
  const LightColumns some = columnsOfRows(all, rows);
  ASSERT_EQ(some.dims, 16u);
  AlignedFloats a(all.stride()), b(some.stride());
  double hardlySeen = 0, count = 0;
  std::vector<double> squares, elsewheres;
  for (size_t i = 0; i < all.count; ++i) {
    all.load(i, a.data());
    double squared = 0;
    int seen = 0;
    for (const RowFactor& row : rows) {
      double own = 0;
      for (size_t c = 0; c < 3; ++c)
        own += std::pow(double{a[3 * row.row + c] * all.weight[i] * row.factor}, 2);
      squared += own;
      seen += own > 0 ? 1 : 0;
    }
    double whole = 0;
    for (size_t d = 0; d < all.dims; ++d) whole += std::pow(double{a[d] * all.weight[i]}, 2);
    const double elsewhere =
        kElsewhereFactor * std::sqrt(whole / (static_cast<double>(all.dims) / 3));
    elsewheres.push_back(elsewhere);
    squared += elsewhere * elsewhere;
    squares.push_back(squared);
    if (seen <= 1) hardlySeen += std::sqrt(squared), ++count;
  }
  ASSERT_GT(count, 0);
  EXPECT_NEAR(some.unseen, std::pow(kUnseenShare * hardlySeen / count, 2), 1e-5 * some.unseen);
  for (size_t i = 0; i < all.count; ++i) {
    EXPECT_NEAR(some.weight[i], std::sqrt(squares[i] + some.unseen), 1e-4 * some.weight[i]);
    all.load(i, a.data());
    some.load(i, b.data());
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(b[c] * some.weight[i], a[21 + c] * all.weight[i], 1e-4f * some.weight[i]);
      EXPECT_NEAR(b[3 + c] * some.weight[i], 0.5f * a[6 + c] * all.weight[i],
                  1e-4f * some.weight[i]);
    }
    EXPECT_NEAR(b[6] * some.weight[i], elsewheres[i], 1e-4 * elsewheres[i]);
  }
}

TEST_F(LightSlice, AsManyColumnsAsLightsAreTheSum) {
  settings_.columns = 600;
  expectEqual(some(), all());
}

TEST_F(LightSlice, MeanOverSeedsIsTheLightOfAll) {
  expectUnbiased(all(), 100, [&](uint64_t draw) { return some(draw); });
}

// The slices' own rows tell more than all rows alone.
TEST_F(LightSlice, RefiningBySliceLessensTheError) {
  for (ReceiverPoint& point : receivers_.points) {  // a floor
    point.p = {0.1f * static_cast<float>(point.pixel % 20) - 1,
               0.1333f * static_cast<float>(point.pixel / 20) - 1, -1};
    point.frame = frameFromNormal({0, 0, 1});
    point.ng = point.frame.n;
    point.wo = normalize(Vec3f{0.1f, 0.2f, 1});
    receivers_.lobes[point.firstLobe] = Lobe{};
    receivers_.lobes[point.firstLobe].weight = Rgb(0.5f);
  }
  const std::vector<Rgb> exact = all();
  const auto error = [&](double globalShare) {
    settings_.globalShare = globalShare;
    double sum = 0;
    for (uint64_t seed = 0; seed < 8; ++seed) sum += relativeError(some(seed), exact);
    return sum;
  };
  settings_.slices = 40;
  EXPECT_LT(error(0.3), 0.7 * error(1));
}

TEST_F(LightSlice, ThreadsDoNotMatterAndSeedsDo) { expectSameForAnyThreads(); }
TEST_F(LightSlice, OnePixelAloneHasTheSameBits) { expectSameBitsForOnePixel(); }
TEST_F(LightSlice, PartsAddUp) {
  settings_.columns = 600;  // no rays but the receivers'
  expectPartsAddUp();
}

TEST_F(LightSlice, StatisticsSayWhatSlicesShare) {
  some();
  const Statistics& s = context_.statistics;
  EXPECT_EQ(s.count("receiver_clusters"), 12u);
  EXPECT_EQ(s.count("clustered_receivers"), 300u);
  EXPECT_EQ(s.count("cut_lights"), 12u * 100);
  EXPECT_EQ(s.count("clustered_lights"), 12u * 600);
  EXPECT_GT(s.count("shadow_rays"), 0u);
}

// Rows of 12 slices, padded to 48 floats, take 200 bytes per light; what a slice makes of its own
// ones comes on top.
TEST_F(LightSlice, MemoryCountsRowsAndClusters) {
  settings_.memory = 600 * 200;
  EXPECT_THROW(some(), UsageError);
  settings_.memory = 600 * 320;
  EXPECT_GT(sum(some()), 0);
  const LightColumns rows = columnsFrom(scatteredVectors(40, 48, 5, 2), 0);
  const RowFactor factors[] = {{7, 1.f}, {2, 0.5f}, {3, 0.5f}, {4, 0.5f}, {5, 0.5f}, {6, 0.5f}};
  EXPECT_GT(rows.count * sliceBytes(std::size(factors)), columnsOfRows(rows, factors).bytes());
}

// A picture whose sampled pixels see nothing must not gather all lights.
TEST_F(LightSlice, WithoutASampleLightsAreDrawnByPower) {
  for (OmniLight& light : lights_.omni) light.intensity *= 0.01f;
  const std::vector<Rgb> exact = all();
  expectUnbiased(exact, 100, [&](uint64_t draw) {
    settings_.gather = gather_;
    settings_.seed = draw;
    const LightSlices slices(tracer_, {}, lights_, settings_, context_);
    EXPECT_LE(slices.lightsPerSlice(), 100.0);
    EXPECT_GT(slices.lightsPerSlice(), 60.0);
    std::vector<Rgb> radiance(receivers_.points.size());
    slices.gather(receivers_, kAll, radiance, context_);
    return radiance;
  });
}

TEST_F(LightSlice, TooLittleMemoryIsSaid) {
  settings_.memory = 1000;
  try {
    some();
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("--slices"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace lobelia
