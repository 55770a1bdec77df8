// Lights that matter much alone, against each light's own contribution.
#include "lobelia/gather/dominant_lights.h"

#include "gather/strategy_test.h"
#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/gather_cuts.h"
#include "lobelia/gather/receiver_clusters.h"
#include "lobelia/gather/tree_lights.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

// Patches of floor and walls under many sharp lights, with nothing between.
class Dominant : public testing::Test {
 protected:
  static constexpr int kPatches = 24, kSide = 4, kWidth = kPatches * kSide;

  Dominant() {
    for (Vec3f& p : scene_.meshes[0].positions) p += Vec3f(50.f);
    Rng rng(8);
    for (int patch = 0; patch < kPatches; ++patch) {
      const Vec3f centre = randomPoint(&rng, 1);
      const Frame frame = frameFromNormal(randomDirection(&rng));
      for (int i = 0; i < kSide * kSide; ++i) {
        const int at = patch * kSide * kSide + i, x = i % kSide, y = i / kSide;
        ReceiverPoint& point = receivers_.points[static_cast<size_t>(at)];
        point.pixel = static_cast<uint32_t>(patch * kSide + x + y * kWidth);
        point.p = centre + frame.s * (0.01f * static_cast<float>(x)) +
                  frame.t * (0.01f * static_cast<float>(y));
        point.frame = frame;
        point.ng = frame.n;
        point.wo = normalize(frame.n + 0.5f * frame.s);
        point.weight = Rgb(1.f);
      }
    }
    VirtualLights random = randomLights(3000, 100.f, 5);
    lights_.glossy = random.glossy;
    lights_.glossyDepthEnds = {0, static_cast<uint32_t>(lights_.glossy.size())};
    for (GlossyLight& light : lights_.glossy) {
      light.p *= 1.2f;
      light.sharpness = std::exp(9 * rng.next1D());
      light.intensity = Rgb(light.sharpness * rng.next1D());
    }
    settings_.gather.direct = true;
    settings_.width = kWidth;
  }

  std::vector<Rgb> of(const GlossyLight& light) {
    VirtualLights one;
    one.glossy = {light};
    one.glossyDepthEnds = {0, 1};
    return lightOfAll(tracer_, receivers_, one, settings_.gather, context_);
  }

  Scene scene_ = randomTriangles(1, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
  Receivers receivers_ = randomReceivers(kPatches * kSide * kSide, {LobeType::lambert}, 1, 3);
  VirtualLights lights_;
  CutGatherSettings settings_;
};

TEST_F(Dominant, LightsFindWhereTheyMatter) {
  const LightNumbers numbers(lights_, settings_.gather);
  auto inputs = treeLights(lights_, numbers, scene_, tracer_.bounds(), {});
  std::vector<trees::LightTree> trees;
  for (const TreeLights& input : inputs) trees.emplace_back(input.lights, input.numbers, 3.f);
  const ReceiverClusters clusters = clusterReceivers(receivers_, 3, kWidth);
  std::vector<ClusterTarget> targets;
  for (const ReceiverClusters::Cluster& cluster : clusters.clusters) {
    Tile tile = makeTile(clusters.receivers, cluster.begin, cluster.end);
    addSampling(clusters.receivers, &tile);
    ClusterTarget& target = targets.emplace_back();
    target.representatives = cluster.representatives;
    target.receivers = cutReceivers(tile, clusters.receivers);
    target.least = 0.3f;
  }
  const DominantLights dominant(targets, trees, context_);
  // What each light gives each cluster: the root of the sum of squares.
  std::vector<std::vector<float>> value(clusters.clusters.size(),
                                        std::vector<float>(lights_.glossy.size()));
  for (size_t l = 0; l < lights_.glossy.size(); ++l) {
    const std::vector<Rgb> light = of(lights_.glossy[l]);
    for (size_t c = 0; c < clusters.clusters.size(); ++c) {
      for (uint32_t i = clusters.clusters[c].begin; i < clusters.clusters[c].end; ++i)
        value[c][l] += sqr(luminance(light[clusters.order[i]]));
      value[c][l] = std::sqrt(value[c][l]);
    }
  }
  size_t found = 0, missed = 0, strong = 0;
  for (size_t c = 0; c < clusters.clusters.size(); ++c) {
    std::vector<bool> named(lights_.glossy.size(), false);
    for (const DominantLights::Leaf& leaf : dominant.of(c)) {
      const trees::LightTree& tree = trees[leaf.tree];
      const uint32_t number = tree.light(tree.nodes()[leaf.node].link);
      EXPECT_FALSE(named[number]) << "twice";
      named[number] = true;
      ++found;
    }
    for (size_t l = 0; l < named.size(); ++l) {
      if (value[c][l] < 0.6f) continue;
      ++strong;
      if (!named[l]) ++missed;
    }
  }
  EXPECT_GT(strong, 100u);
  EXPECT_EQ(missed, 0u);
  EXPECT_LT(found, 3 * strong) << "of " << lights_.glossy.size() * targets.size();
}

// A lobe as narrow as a cluster, among thousands that miss it, which no node tells of.
TEST_F(Dominant, ASharpLightIsNotLeftToChance) {
  for (GlossyLight& light : lights_.glossy) light.intensity *= 0.05f;
  GlossyLight& sharp = lights_.glossy[77];
  const ReceiverPoint& lit = receivers_.points[0];
  sharp.p = lit.p + 0.7f * lit.frame.n;
  sharp.n = sharp.axis = -lit.frame.n;
  sharp.sharpness = 2e4f;
  sharp.intensity = Rgb(10.f);
  settings_.cut.nodes = 16;
  const Rgb own = of(sharp)[0];
  EXPECT_GT(
      own.x,
      1.5f * (lightOfAll(tracer_, receivers_, lights_, settings_.gather, context_)[0].x - own.x));
  for (uint64_t seed = 0; seed < 40; ++seed) {
    settings_.seed = seed;
    const LightCuts cuts(tracer_, lights_, settings_, context_);
    const Rgb light = lightOf(cuts, receivers_, context_, nullptr, receivers_.points[0].pixel)[0];
    EXPECT_GE(light.x, 0.999f * own.x) << seed;
    EXPECT_LE(light.x, 4 * own.x) << seed;
  }
}

// So near to one receiver that no mean of a cluster's tells of it: still found.
TEST_F(Dominant, ANearLightOfOneReceiver) {
  GlossyLight& near = lights_.glossy[77];
  const size_t lit = 5;
  const ReceiverPoint& point = receivers_.points[lit];
  near.p = point.p + 2e-4f * point.frame.n;
  near.n = near.axis = -point.frame.n;
  near.sharpness = 1;
  near.intensity = Rgb(1.f);
  const std::vector<Rgb> own = of(near);
  EXPECT_GT(own[lit].x, 100 * own[lit + 1].x);
  near.intensity *= 1 / own[lit].x;
  for (GlossyLight& light : lights_.glossy)
    if (&light != &near) light.intensity *= 1e-3f;
  settings_.cut.nodes = 16;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    settings_.seed = seed;
    const LightCuts cuts(tracer_, lights_, settings_, context_);
    const Rgb light = lightOf(cuts, receivers_, context_)[lit];
    EXPECT_GE(light.x, 0.99f) << seed;
    EXPECT_LE(light.x, 1.5f) << seed;
  }
}

TEST_F(Dominant, NothingToLookFor) {
  const std::vector<ClusterTarget> none(3);
  const DominantLights dominant(none, {}, context_);
  for (size_t i = 0; i < none.size(); ++i) EXPECT_TRUE(dominant.of(i).empty());
}

}  // namespace
}  // namespace lobelia
