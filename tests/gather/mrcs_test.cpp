// Few lights for many: unbiased at every receiver.
#include <gtest/gtest.h>

#include "gather/mrcs_input.h"
#include "gather/unbiased.h"
#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class Mrcs : public testing::Test {
 protected:
  static constexpr int kWidth = 20, kHeight = 15;

  Mrcs() {
    settings_.gather.direct = true;
    settings_.gather.clamp = 3;
  }
  std::vector<Rgb> gather(const VirtualLights& lights) {
    std::vector<Rgb> radiance(receivers_.points.size());
    gatherAll(tracer_, receivers_, lights, settings_.gather, radiance, context_);
    return radiance;
  }
  VirtualLights reduce(uint64_t seed, size_t rows = 40) {
    settings_.seed = seed;
    return reduceLights(tracer_, rowsOf(receivers_, kWidth, kHeight, rows, seed), lights_,
                        settings_, &report_, context_);
  }
  void expectUnbiased(int draws) {
    test::expectUnbiased(gather(lights_), draws, [&](uint64_t draw) {
      const VirtualLights few = reduce(draw);
      EXPECT_LE(few.size(), settings_.columns);
      return gather(few);
    });
  }

  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  Receivers receivers_ = randomReceivers(static_cast<size_t>(kWidth * kHeight),
                                         {LobeType::lambert, LobeType::phong}, 2, 3);
  VirtualLights lights_ = randomLights(60, 100.f, 5);
  MrcsSettings settings_;
  MrcsReport report_;
};

TEST_F(Mrcs, MeanOverSeedsIsTheLightOfAll) {
  settings_.columns = 40;
  expectUnbiased(500);
  EXPECT_EQ(report_.sketch, 0u) << "so few columns are kept whole";
  settings_.sketch = 32;
  expectUnbiased(300);
  EXPECT_EQ(report_.sketch, 32u);
  settings_.gather.maxDepth = 4;
  expectUnbiased(300);
}

TEST_F(Mrcs, AsManyColumnsAsLightsChangeNothing) {
  settings_.columns = lights_.size();
  EXPECT_EQ(gather(reduce(1)), gather(lights_));
  // And when the error that is asked for needs them all.
  settings_.errorLimit = 1e-7;
  const VirtualLights all = reduce(1);
  EXPECT_EQ(all.size(), lights_.size());
  EXPECT_EQ(gather(all), gather(lights_));
}

TEST_F(Mrcs, ClassesDepthsAndGroupsAreKept) {
  for (size_t i = 0; i < lights_.glossy.size(); ++i) {
    lights_.glossyGroups.push_back(static_cast<uint16_t>(i % 3));
    lights_.omniGroups.push_back(static_cast<uint16_t>(i % 5));
    lights_.directionalGroups.push_back(0);
  }
  settings_.columns = 60;
  const VirtualLights few = reduce(2);
  EXPECT_EQ(few.size(), report_.columns);
  EXPECT_GT(few.omni.size(), 0u);
  EXPECT_GT(few.directional.size(), 0u);
  EXPECT_GT(few.diffuse.size(), 0u);
  ASSERT_GT(few.glossy.size(), 0u);
  ASSERT_EQ(few.glossyGroups.size(), few.glossy.size());
  ASSERT_EQ(few.omniGroups.size(), few.omni.size());
  for (size_t i = 0; i < few.glossy.size(); ++i) {
    const auto same = [&](const GlossyLight& l) { return l.p == few.glossy[i].p; };
    const auto it = std::find_if(lights_.glossy.begin(), lights_.glossy.end(), same);
    ASSERT_NE(it, lights_.glossy.end());
    const auto index = static_cast<uint32_t>(it - lights_.glossy.begin());
    EXPECT_EQ(few.glossyGroups[i], index % 3);
    EXPECT_EQ(few.glossy[i].sharpness, it->sharpness);
    EXPECT_EQ(few.glossy[i].axis, it->axis);
    for (size_t d = 0; d < lights_.glossyDepthEnds.size(); ++d)
      EXPECT_EQ(i < few.glossyDepthEnds[d], index < lights_.glossyDepthEnds[d]);
    // One factor for all channels, 1 or more.
    const Rgb scale = few.glossy[i].intensity / it->intensity;
    EXPECT_NEAR(scale.y, scale.x, 1e-5f * scale.x);
    EXPECT_NEAR(scale.z, scale.x, 1e-5f * scale.x);
    EXPECT_GT(scale.x, 0.9999f);
  }
}

TEST_F(Mrcs, SameBitsForAnyNumberOfThreads) {
  settings_.columns = 50;
  settings_.sketch = 48;
  std::vector<std::vector<Rgb>> results;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    results.push_back(gather(reduce(3)));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

// A lamp behind the scene that lights a corner: none of the rows see it.
TEST_F(Mrcs, LightThatNoRowSeesCounts) {
  lights_ = randomLights(20, 1.f, 6);
  lights_.glossy.assign(1, GlossyLight{});
  GlossyLight& lamp = lights_.glossy[0];
  const ReceiverPoint& lit = receivers_.points[77];
  lamp.axis = lamp.n = lit.wo;
  lamp.p = lit.p - lit.wo * 1e-3f;
  lamp.intensity = Rgb(1e-6f);
  lamp.sharpness = 1e6f;
  for (uint32_t& end : lights_.glossyDepthEnds) end = 1;
  receivers_.points[77].frame = frameFromNormal(-lit.wo);
  receivers_.points[77].ng = receivers_.points[77].wo = -lit.wo;
  settings_.columns = 12;
  constexpr int kDraws = 400;
  int drawn = 0, seen = 0;
  double sum = 0;
  for (uint64_t draw = 0; draw < kDraws; ++draw) {
    const gather::Rows rows = rowsOf(receivers_, kWidth, kHeight, 30, draw);
    const auto isLit = [&](const ReceiverPoint& p) { return p.pixel == 77; };
    seen += std::any_of(rows.receivers.points.begin(), rows.receivers.points.end(), isLit);
    const VirtualLights few = reduce(draw, 30);
    if (few.glossy.empty()) continue;
    ++drawn;
    sum += double{few.glossy[0].intensity.x / lamp.intensity.x};
  }
  EXPECT_LT(seen, kDraws / 2);
  EXPECT_GT(drawn, kDraws / 200);
  // The mean of its scale over draws is 1: deviations of the scale s are sqrt(s) at most.
  EXPECT_NEAR(sum / kDraws, 1, 4 * std::sqrt(sum / drawn / kDraws));
}

TEST_F(Mrcs, ScalePerChannelKeepsChannelsOfTheRows) {
  settings_.columns = 40;
  settings_.scalePerChannel = true;
  const std::vector<double> exact = groupSums(gather(lights_));
  double mean = 0;
  for (uint64_t draw = 0; draw < 100; ++draw) mean += groupSums(gather(reduce(draw)))[12] / 100;
  EXPECT_NEAR(mean, exact[12], 0.15 * exact[12]) << "biased, but not by more than the papers say";
}

TEST_F(Mrcs, TooLittleMemoryIsAnError) {
  settings_.columns = 40;
  settings_.memory = 1000;
  try {
    reduce(1);
    FAIL() << "it fits";
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("--memory"), std::string::npos) << e.what();
  }
  settings_.memory = 240 * (2 * (32 + 16) + 8);  // for sketches of 32 numbers
  reduce(1);
  EXPECT_EQ(report_.sketch, 32u);
  settings_.sketch = 64;
  EXPECT_THROW(reduce(1), UsageError);
  settings_.sketch = 0;
  EXPECT_THROW(reduce(1), UsageError);
}

}  // namespace
}  // namespace lobelia
