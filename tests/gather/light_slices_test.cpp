// LightSlice against the sum over all lights.
#include "lobelia/gather/light_slices.h"

#include "gather/mrcs_input.h"
#include "gather/unbiased.h"
#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/slice_clusters.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

constexpr uint32_t kAll = GatherSettings::kAllPixels;

class LightSlice : public testing::Test {
 protected:
  LightSlice() {
    settings_.gather.direct = true;
    settings_.gather.clamp = 3;
    settings_.slices = 12;
    settings_.columns = 100;
    settings_.rows = 5;
  }
  std::vector<Rgb> all(const VirtualLights& lights) {
    std::vector<Rgb> radiance(receivers_.points.size());
    gatherAll(tracer_, receivers_, lights, settings_.gather, radiance, context_);
    return radiance;
  }
  std::vector<Rgb> some(const VirtualLights& lights, GatherParts* parts = nullptr) {
    std::vector<Rgb> radiance(receivers_.points.size());
    const LightSlices slices(tracer_, receivers_, lights, settings_, context_);
    slices.gather(receivers_, kAll, radiance, context_, parts);
    return radiance;
  }

  Receivers receivers_ =
      randomReceivers(300, {LobeType::lambert, LobeType::phong, LobeType::ward}, 1, 3);
  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  VirtualLights lights_ = randomLights(150, 100.f, 5);
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
  std::vector<double> squares;
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
  }
}

TEST_F(LightSlice, AsManyColumnsAsLightsAreTheSum) {
  settings_.columns = 600;
  EXPECT_EQ(context_.statistics.seconds("rows"), 0);
  const std::vector<Rgb> exact = all(lights_), sliced = some(lights_);
  for (size_t i = 0; i < exact.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(sliced[i][c], exact[i][c], 2e-5f * exact[i][c] + 1e-12f) << i;
}

TEST_F(LightSlice, MeanOverSeedsIsTheLightOfAll) {
  expectUnbiased(all(lights_), 100, [&](uint64_t draw) {
    settings_.seed = draw;
    return some(lights_);
  });
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
  const std::vector<Rgb> exact = all(lights_);
  const auto error = [&](double globalShare) {
    settings_.globalShare = globalShare;
    double sum = 0;
    for (settings_.seed = 0; settings_.seed < 8; ++settings_.seed) {
      const std::vector<Rgb> light = some(lights_);
      for (size_t i = 0; i < exact.size(); ++i) sum += double{lengthSquared(light[i] - exact[i])};
    }
    return sum;
  };
  settings_.slices = 40;
  EXPECT_LT(error(0.3), 0.5 * error(1));
}

TEST_F(LightSlice, ThreadsDoNotMatterAndSeedsDo) {
  const std::vector<Rgb> many = some(lights_);
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(some(lights_), many);
  }
  settings_.seed = 1;
  EXPECT_NE(some(lights_), many);
}

TEST_F(LightSlice, OnePixelAloneHasTheSameBits) {
  const LightSlices slices(tracer_, receivers_, lights_, settings_, context_);
  std::vector<Rgb> whole(receivers_.points.size()), one = whole;
  slices.gather(receivers_, kAll, whole, context_);
  slices.gather(receivers_, 37, one, context_);
  EXPECT_EQ(one[37], whole[37]);
  EXPECT_NE(one[37], Rgb{});
}

TEST_F(LightSlice, PartsAddUp) {
  lights_.groups = {"a", "b"};
  lights_.omniGroups.assign(lights_.omni.size(), 1);
  GatherParts parts;
  parts.groupCount = 2, parts.byType = true, parts.countRays = true;
  settings_.columns = 600;
  const std::vector<Rgb> whole = some(lights_, &parts);
  const size_t n = whole.size();
  uint64_t rays = 0;
  for (size_t i = 0; i < n; ++i) {
    Rgb types;
    for (size_t t = 0; t < GatherParts::kTypes; ++t) types += parts.types[t * n + i];
    const Rgb groups = parts.groups[i] + parts.groups[n + i];
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(types[c], whole[i][c], 1e-4f * whole[i][c] + 1e-9f);
      EXPECT_NEAR(groups[c], whole[i][c], 1e-4f * whole[i][c] + 1e-9f);
    }
    rays += parts.rays[i];
  }
  EXPECT_EQ(rays, context_.statistics.count("shadow_rays"));
}

TEST_F(LightSlice, StatisticsSayWhatSlicesShare) {
  some(lights_);
  const Statistics& s = context_.statistics;
  EXPECT_EQ(s.count("receiver_clusters"), 12u);
  EXPECT_EQ(s.count("clustered_receivers"), 300u);
  EXPECT_EQ(s.count("cut_lights"), 12u * 100);
  EXPECT_EQ(s.count("clustered_lights"), 12u * 600);
  EXPECT_GT(s.count("shadow_rays"), 0u);
}

TEST_F(LightSlice, TooLittleMemoryIsSaid) {
  settings_.memory = 1000;
  try {
    some(lights_);
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("--slices"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace lobelia
