// Multidimensional lightcuts against the sum over all lights.
#include "lobelia/gather/multidimensional_lightcuts.h"

#include "gather/lit_corner.h"
#include "gather/strategy_test.h"
#include "lobelia/gather/lightcuts.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class MultidimensionalGather : public StrategyTest {
 protected:
  static constexpr size_t kSamples = 8;  // receivers of a pixel

  MultidimensionalGather() {
    for (size_t i = 0; i < receivers_.points.size(); ++i)
      receivers_.points[i].pixel = static_cast<uint32_t>(i / kSamples);
  }
  std::unique_ptr<PreparedGather> prepare(uint64_t seed) override {
    settings_.gather = gather_;
    settings_.seed = seed;
    return std::make_unique<MultidimensionalLightcuts>(*use_, lights_, settings_, context_);
  }
  std::vector<Rgb> pixels(const std::vector<Rgb>& light) const {
    std::vector<Rgb> sums;
    for (size_t i = 0; i < light.size(); ++i) {
      sums.resize(std::max<size_t>(sums.size(), receivers_.points[i].pixel + 1));
      sums[receivers_.points[i].pixel] += light[i];
    }
    return sums;
  }
  MultidimensionalSettings settings_;
};

class MultidimensionalOfWalls : public MultidimensionalGather {
 protected:
  MultidimensionalOfWalls() {
    receivers_ = randomReceivers(800, {LobeType::lambert, LobeType::phong}, 1, 3);
    layOnFloor(&receivers_, 5);
    Rng rng(8);
    for (size_t i = 0; i < receivers_.points.size(); ++i) {
      ReceiverPoint& point = receivers_.points[i];
      const size_t first = i / kSamples * kSamples;
      point.pixel = static_cast<uint32_t>(i / kSamples);
      const Vec3f aside = randomPoint(&rng, 0.01f);
      point.p = receivers_.points[first].p + Vec3f{aside.x, aside.y, 0};
      // One surface covers a pixel.
      const ReceiverPoint& one = receivers_.points[first];
      point.firstLobe = one.firstLobe, point.lobeCount = one.lobeCount;
    }
    lights_ = wallOfLights(2000, 5);
    gather_.clamp = 0;
    use_ = &corner_;
  }
  Scene triangles_ = trianglesAboveFloor();
  Tracer corner_{triangles_, context_};
};

TEST_F(MultidimensionalGather, WithoutAThresholdLargeCutsAreTheSum) {
  settings_.threshold = 0;
  settings_.cutSize = 100'000;
  expectEqual(some(), all());
  gather_.clamp = 0;
  gather_.maxDepth = 4;
  expectEqual(some(), all());
}

// In any order, with more receivers than one tree takes.
TEST_F(MultidimensionalGather, PixelsOfManyReceivers) {
  for (size_t i = 0; i < receivers_.points.size(); ++i)
    receivers_.points[i].pixel = i % 4 == 0 ? 3 : 1 + static_cast<uint32_t>(i % 2);
  for (ReceiverPoint& point : receivers_.points)
    if (point.pixel == 2) point.pixel = 1;
  receivers_.points.resize(299);
  receivers_.points.insert(receivers_.points.end(), receivers_.points.begin(),
                           receivers_.points.begin() + 200);
  settings_.threshold = 0;
  settings_.cutSize = 1'000'000;
  expectEqual(some(), all());
  settings_.threshold = 0.005;
  EXPECT_LT(relativeError(pixels(some()), pixels(all())), 0.05);
}

TEST_F(MultidimensionalOfWalls, SmallerThresholdsComeNearerAtMorePairs) {
  const std::vector<Rgb> exact = pixels(all());
  double error = 1;
  uint64_t pairs = 0, rays = 0;
  for (const double threshold : {0.2, 0.05, 0.01}) {
    settings_.threshold = threshold;
    settings_.cutSize = 10'000;
    std::vector<Rgb> light;
    uint64_t more = 0;
    const uint64_t morePairs = growth(
        "cut_lights", [&] { more = growth("shadow_rays", [&] { light = pixels(some()); }); });
    EXPECT_LT(relativeError(light, exact), 0.8 * error) << threshold;
    EXPECT_GT(morePairs, pairs) << threshold;
    EXPECT_GT(more, rays) << threshold;
    error = relativeError(light, exact), pairs = morePairs, rays = more;
  }
  EXPECT_LT(error, 0.03);
}

// What a pixel's samples share: at one threshold a cut of the pixel takes few more rays than one of
// a single receiver.
TEST_F(MultidimensionalOfWalls, APixelCostsLessThanItsReceivers) {
  const std::vector<Rgb> exact = pixels(all());
  settings_.threshold = 0.02;
  settings_.cutSize = 10'000;
  std::vector<Rgb> whole, single(receivers_.points.size());
  const uint64_t rays = growth("shadow_rays", [&] { whole = some(); });
  const Lightcuts cuts(*use_, lights_, {gather_, 0.02, 10'000, 0}, context_);
  const uint64_t singleRays =
      growth("shadow_rays", [&] { cuts.gather(receivers_, kAll, single, context_, nullptr); });
  EXPECT_LT(rays, singleRays / 3);
  EXPECT_LT(relativeError(pixels(whole), exact), 1.2 * relativeError(pixels(single), exact));
}

TEST_F(MultidimensionalOfWalls, CutsOfFixedSizeAreUnbiasedOverRepresentatives) {
  lights_ = wallOfLights(200, 5);
  settings_.threshold = 0;
  settings_.cutSize = 150;
  expectUnbiased(all(), 80, [&](uint64_t draw) { return some(draw); });
  EXPECT_EQ(context_.statistics.count("cut_lights"), 80u * 100 * 150);
}

TEST_F(MultidimensionalGather, EveryClassAlone) {
  settings_.threshold = 0.01;
  settings_.cutSize = 10'000;
  withEveryClassAlone([&] { EXPECT_LT(relativeError(pixels(some()), pixels(all())), 0.05); });
}

// Filters weight samples below 0, too.
TEST_F(MultidimensionalGather, WeightsMayBeNegative) {
  for (size_t i = 0; i < receivers_.points.size(); i += 3)
    receivers_.points[i].weight = receivers_.points[i].weight * -0.1f;
  settings_.threshold = 0.01;
  settings_.cutSize = 10'000;
  EXPECT_LT(relativeError(pixels(some()), pixels(all())), 0.05);
}

// Of gray lights and receivers: what a pair of nodes sends is below its bound.
TEST_F(MultidimensionalGather, BoundsOfPairsHold) {
  receivers_ = randomReceivers(24, {LobeType::lambert}, 1, 3);
  for (Lobe& lobe : receivers_.lobes) lobe.weight = Rgb(lobe.weight.x);
  for (ReceiverPoint& point : receivers_.points) point.weight = Rgb(point.weight.x);
  VirtualLights gray;
  gray.diffuse = lights_.diffuse;
  for (DiffuseLight& light : gray.diffuse) light.intensity = Rgb(light.intensity.x);
  gray.diffuseDepthEnds = lights_.diffuseDepthEnds;
  gather_.clamp = 0;
  const Scene none;
  const Tracer open(none, context_);
  const LightForest forest = plantLights(gray, gather_, 1, none, {{-1, -1, -1}, {1, 1, 1}}, {});
  const Tile tile = makeTile(receivers_, 0, receivers_.points.size());
  const GatherTree tree(receivers_, 0, receivers_.points.size(), tile, 2, 0);
  WholeBounds bounder;
  int close = 0;
  for (uint32_t p = 0; p < tree.tree().nodes().size(); ++p) {
    Receivers some{{}, receivers_.lobes};
    const trees::BoundNode& node = tree.tree().nodes()[p];
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const uint32_t item = tree.tree().item(i);  // of the tile's order
      some.points.push_back(receivers_.points[tile.strips[item / kStrip].point[item % kStrip]]);
    }
    const auto lightNodes = forest.trees[0].tree.nodes();
    for (uint32_t q = 0; q < lightNodes.size(); q += 7) {
      VirtualLights part;
      for (uint32_t i = lightNodes[q].first; i < lightNodes[q].first + lightNodes[q].count; ++i)
        part.diffuse.push_back(gray.diffuse[forest.trees[0].lights[i]]);
      part.diffuseDepthEnds.assign(gray.diffuseDepthEnds.size(),
                                   static_cast<uint32_t>(part.diffuse.size()));
      std::vector<Rgb> light(some.points.size());
      gatherAll(open, some, part, gather_, light, context_);
      double all = 0;
      for (const Rgb& value : light) all += double{value.x};
      const NodePair pair{&node, &lightNodes[q]};
      float upper = 0;
      bounder.bound({&pair, 1}, LightClass::diffuse, tree.glossy(), &upper);
      const double bound = double{upper} * double{tree.mostStrength(p)};
      EXPECT_LE(all, bound * 1.0001) << p << " " << q;
      close += all > 0.5 * bound && all > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(close, 50) << "and not far below it, of leaves";
}

TEST_F(MultidimensionalOfWalls, ThreadsDoNotMatterAndSeedsDo) { expectSameForAnyThreads(); }

TEST_F(MultidimensionalOfWalls, OnePixelAloneHasTheSameBits) {
  const std::vector<Rgb> whole = pixels(some()), one = pixels(some(0, nullptr, 37));
  EXPECT_EQ(one[37], whole[37]);
  EXPECT_NE(one[37], Rgb{});
  EXPECT_EQ(std::count_if(one.begin(), one.end(), [](Rgb v) { return v != Rgb{}; }), 1);
}

TEST_F(MultidimensionalGather, PartsAddUp) { expectPartsAddUp(); }

// The cut of the pixel before is not theirs.
TEST_F(MultidimensionalGather, PartsOfPixelsWithoutLobes) {
  for (ReceiverPoint& point : receivers_.points)
    if (point.pixel % 3 == 1) point.lobeCount = 0;
  expectPartsAddUp();
}

// Rays by themselves are those of the cut; what takes light apart traces them again.
TEST_F(MultidimensionalGather, RaysOfPartsCount) {
  GatherParts rays;
  rays.countRays = true;
  GatherParts types = rays;
  types.byType = true;
  const uint64_t plain = growth("shadow_rays", [&] { some(); });
  EXPECT_EQ(growth("shadow_rays", [&] { some(0, &rays); }), plain);
  EXPECT_GT(growth("shadow_rays", [&] { some(0, &types); }), plain);
}

TEST_F(MultidimensionalGather, NothingWhenCancelled) {
  context_.cancel();
  EXPECT_EQ(sum(some()), 0);
}

TEST_F(MultidimensionalGather, NoLightsNoReceivers) {
  lights_ = {};
  EXPECT_EQ(sum(some()), 0);
  receivers_ = {};
  EXPECT_TRUE(some().empty());
}

}  // namespace
}  // namespace lobelia
