// Stochastic lightcuts against the sum over all lights.
#include "lobelia/gather/stochastic_lightcuts.h"

#include <map>

#include "gather/strategy_test.h"
#include "lobelia/gather/cut_descent.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class StochasticGather : public StrategyTest {
 protected:
  StochasticGather() {
    settings_.cutSize = 60;
    receivers_.points.resize(144);
  }
  std::unique_ptr<PreparedGather> prepare(uint64_t seed) override {
    settings_.gather = gather_;
    settings_.seed = seed;
    return std::make_unique<StochasticLightcuts>(tracer_, lights_, settings_, context_);
  }
  StochasticSettings settings_;
};

TEST_F(StochasticGather, ACutOfAllLightsIsTheSum) {
  settings_.cutSize = 600;
  expectEqual(some(), all());
}

TEST_F(StochasticGather, MeanOverSeedsIsTheLightOfAll) {
  expectUnbiased(all(), 60, [&](uint64_t draw) { return some(draw); });
  gather_.maxDepth = 4;
  expectUnbiased(all(), 60, [&](uint64_t draw) { return some(draw); });
}

TEST_F(StochasticGather, CutsByAThresholdAreUnbiasedToo) {
  settings_.cutSize = 1000;
  settings_.threshold = 0.1f;
  expectUnbiased(all(), 50, [&](uint64_t draw) { return some(draw); });
  const Statistics& s = context_.statistics;
  EXPECT_LT(2 * s.count("cut_lights"), 600 * s.count("clustered_receivers"));
}

TEST_F(StochasticGather, LargerCutsComeNearer) {
  const std::vector<Rgb> exact = all();
  double before = 10;
  for (const size_t size : {20u, 80u, 320u}) {
    settings_.cutSize = size;
    double error = 0;
    for (uint64_t seed = 0; seed < 4; ++seed) error += relativeError(some(seed), exact) / 4;
    EXPECT_LT(error, 0.7 * before) << size;
    before = error;
  }
}

// Probabilities that a walker is said to have are those that it has.
TEST_F(StochasticGather, DescentsReachEveryLightWithItsProbability) {
  Tile tile = makeTile(receivers_, 5, 6);
  const ReceiverNodes receiver = receiverNodes(receivers_, 5, tile.strips[0]);
  const LightForest forest = plantLights(lights_, gather_, 1, scene_, tracer_.bounds(), {});
  NodeBounder bounder(forest, 0);
  CutDescent descent(forest);
  for (uint32_t t = 0; t < forest.trees.size(); ++t) {
    constexpr size_t kWalkers = 20000;
    std::vector<CutDescent::Walker> walkers(kWalkers);
    for (size_t i = 0; i < kWalkers; ++i)
      walkers[i].u = (static_cast<double>(i) + 0.5) / kWalkers;  // stratified: counts are exact
    descent.run(receiver, t, &bounder, walkers);
    std::map<uint32_t, std::pair<size_t, double>> reached;
    for (const CutDescent::Walker& w : walkers) {
      ASSERT_TRUE(forest.trees[t].tree.nodes()[w.node].leaf());
      auto& [count, probability] = reached[w.node];
      ++count;
      if (probability > 0) {
        EXPECT_EQ(probability, w.probability);
      }
      probability = w.probability;
    }
    double sum = 0;
    for (const auto& [node, at] : reached) {
      EXPECT_NEAR(static_cast<double>(at.first), at.second * kWalkers, 1.001) << node;
      sum += at.second;
    }
    EXPECT_NEAR(sum, 1, 0.01) << "the others are hardly ever reached";
    EXPECT_GT(reached.size(), 10u);
  }
}

TEST_F(StochasticGather, ThreadsDoNotMatterAndSeedsDo) { expectSameForAnyThreads(); }
TEST_F(StochasticGather, OnePixelAloneHasTheSameBits) { expectSameBitsForOnePixel(); }
TEST_F(StochasticGather, PartsAddUp) { expectPartsAddUp(); }

}  // namespace
}  // namespace lobelia
