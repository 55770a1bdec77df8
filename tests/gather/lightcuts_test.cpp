// Lightcuts against the sum over all lights.
#include "lobelia/gather/lightcuts.h"

#include "gather/strategy_test.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class LightcutsGather : public StrategyTest {
 protected:
  std::unique_ptr<PreparedGather> prepare(uint64_t seed) override {
    settings_.gather = gather_;
    settings_.seed = seed;
    return std::make_unique<Lightcuts>(tracer_, lights_, settings_, context_);
  }
  LightcutsSettings settings_;
};

TEST_F(LightcutsGather, WithoutAThresholdLargeCutsAreTheSum) {
  settings_.threshold = 0;
  expectEqual(some(), all());
  gather_.clamp = 0;
  gather_.maxDepth = 4;
  expectEqual(some(), all());
}

TEST_F(LightcutsGather, SmallerThresholdsComeNearerAtMoreNodes) {
  const std::vector<Rgb> exact = all();
  double error = 1;
  uint64_t nodes = 0, rays = 0;
  for (const float threshold : {0.3f, 0.05f, 0.01f}) {
    settings_.threshold = threshold;
    const uint64_t nodesBefore = context_.statistics.count("cut_lights");
    const uint64_t raysBefore = context_.statistics.count("shadow_rays");
    const double now = relativeError(some(), exact);
    EXPECT_LT(now, 0.7 * error) << threshold;
    EXPECT_GT(context_.statistics.count("cut_lights") - nodesBefore, nodes) << threshold;
    EXPECT_GT(context_.statistics.count("shadow_rays") - raysBefore, rays) << threshold;
    error = now;
    nodes = context_.statistics.count("cut_lights") - nodesBefore;
    rays = context_.statistics.count("shadow_rays") - raysBefore;
  }
  EXPECT_LT(error, 0.02);
  EXPECT_LT(nodes, 300u * 600);
}

// What the bound of a node promises holds of the whole cut: every node errs by less than the
// threshold of the sum, and mostly not the same way.
TEST_F(LightcutsGather, ErrorsKeepToTheThreshold) {
  settings_.threshold = 0.02f;
  const std::vector<Rgb> exact = all(), light = some();
  int far = 0;
  for (size_t i = 0; i < exact.size(); ++i)
    far += std::abs(luminance(light[i] - exact[i])) > 0.1f * luminance(exact[i]) ? 1 : 0;
  EXPECT_LT(far, 6) << "of 300 receivers";
}

TEST_F(LightcutsGather, CutsOfFixedSizeAreUnbiasedOverRepresentatives) {
  settings_.threshold = 0;
  settings_.cutSize = 60;
  expectUnbiased(all(), 80, [&](uint64_t draw) { return some(draw); });
  const uint64_t receivers = context_.statistics.count("clustered_receivers");
  EXPECT_EQ(receivers, 80u * 300);
  EXPECT_EQ(context_.statistics.count("cut_lights"), receivers * 60);
}

TEST_F(LightcutsGather, EveryClassAlone) {
  settings_.threshold = 0.01f;
  withEveryClassAlone([&] { EXPECT_LT(relativeError(some(), all()), 0.02); });
}

// A node costs one ray at most, as one of two children shares its parent's light.
TEST_F(LightcutsGather, ChildrenShareTheirParentsLight) {
  settings_.threshold = 0;
  settings_.cutSize = 100;
  some();
  const Statistics& s = context_.statistics;
  EXPECT_LE(s.count("shadow_rays"), s.count("cut_lights"));
  EXPECT_EQ(s.count("node_pairs_visited"), 300u * (4 + 2 * (100 - 4))) << "four trees";
}

TEST_F(LightcutsGather, ThreadsDoNotMatterAndSeedsDo) { expectSameForAnyThreads(); }
TEST_F(LightcutsGather, OnePixelAloneHasTheSameBits) { expectSameBitsForOnePixel(); }
TEST_F(LightcutsGather, PartsAddUp) { expectPartsAddUp(); }

}  // namespace
}  // namespace lobelia
