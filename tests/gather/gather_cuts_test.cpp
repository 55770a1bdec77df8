// Shared stochastic cuts against the sum over all lights.
#include "lobelia/gather/gather_cuts.h"

#include "gather/mrcs_input.h"
#include "gather/spherical_setup.h"
#include "gather/strategy_test.h"
#include "lobelia/gather/receiver_clusters.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class GatherCuts : public testing::Test {
 protected:
  static constexpr int kWidth = 20, kHeight = 15;

  GatherCuts() {
    settings_.gather.direct = true;
    settings_.shared = false;
    settings_.width = kWidth;
  }
  std::vector<Rgb> all(const Tracer& tracer, const VirtualLights& lights) {
    return lightOfAll(tracer, receivers_, lights, settings_.gather, context_);
  }
  std::vector<Rgb> some(const Tracer& tracer, const VirtualLights& lights,
                        GatherParts* parts = nullptr, uint32_t pixel = GatherSettings::kAllPixels) {
    const LightCuts cuts(tracer, lights, settings_, context_);
    return lightOf(cuts, receivers_, context_, parts, pixel);
  }
  // Of more lights than most have, each for itself: with rays of each receiver, or shared ones.
  struct Traced {
    std::vector<Rgb> light;
    uint64_t rays;
  };
  Traced traced(const Tracer& tracer, bool shared) {
    settings_.cut.nodes = 2000;
    settings_.shared = shared;
    const uint64_t before = context_.statistics.count("shadow_rays");
    std::vector<Rgb> light = some(tracer, manyLights_);
    return {std::move(light), context_.statistics.count("shadow_rays") - before};
  }
  void face(ReceiverPoint* point, Vec3f n) {
    point->frame = frameFromNormal(n);
    point->ng = point->frame.n;
  }
  void expectUnbiased(const Tracer& tracer, const VirtualLights& lights, int draws,
                      const std::vector<Rgb>& all) {
    test::expectUnbiased(all, draws, [&](uint64_t draw) {
      settings_.seed = draw;
      return some(tracer, lights);
    });
  }

  Receivers receivers_ =
      randomReceivers(static_cast<size_t>(kWidth * kHeight),
                      {LobeType::lambert, LobeType::phong, LobeType::ward}, 1, 3);
  const VirtualLights manyLights_ = randomLights(1500, 100.f, 5);
  CutGatherSettings settings_;
  Context context_;
};

// Lights of the classes that stand alone, and some that hide them.
class GatherPointCuts : public GatherCuts {
 protected:
  Scene scene_ = randomTriangles(60, 11);
  Tracer tracer_{scene_, context_};
  VirtualLights lights_ = randomLights(300, 100.f, 5);
};

// Spherical lights of several materials.
class GatherSphericalCuts : public GatherCuts, public testing::WithParamInterface<Material> {
 protected:
  static constexpr int kLights = 600;
  GatherSphericalCuts() {
    Rng random(4);
    const SphericalLight light = floor_.lights().spherical[0];
    floor_.lights().spherical.clear();
    for (int i = 0; i < kLights; ++i) {
      SphericalLight l = light;
      const Vec2f u = random.next2D();
      l.p = Vec3f(LitFloor::kMiddle) + Vec3f{3 * u.x - 1.5f, 3 * u.y - 1.5f, 0};
      l.radius = 0.05f + 0.1f * random.next1D();
      const Vec2f v = random.next2D();
      l.arriving = encodeOctahedral(normalize(Vec3f{2 * v.x - 1, 2 * v.y - 1, 0.5f}));
      l.power *= random.next1D();
      floor_.lights().spherical.push_back(l);
    }
    floor_.lights().sphericalDepthEnds = {0, kLights};
    for (ReceiverPoint& point : receivers_.points) point.p += Vec3f(LitFloor::kMiddle);
  }
  LitFloor floor_{GetParam(), 0.3f, {0.2f, 0, 1}};
};

TEST_F(GatherPointCuts, ACutOfAllLightsIsTheSum) {
  const std::vector<Rgb> exact = all(tracer_, lights_), cut = some(tracer_, lights_);
  settings_.cut.nodes = 1200;
  const std::vector<Rgb> whole = some(tracer_, lights_);
  expectEqual(whole, exact);
  EXPECT_GT(relativeError(cut, exact), 1e-3) << "1024 of 1200 lights";
}

TEST_F(GatherPointCuts, MeanOverSeedsIsTheLightOfAll) {
  settings_.cut.nodes = 100;
  settings_.gather.clamp = 3;
  expectUnbiased(tracer_, lights_, 300, all(tracer_, lights_));
  settings_.gather.maxDepth = 4;
  expectUnbiased(tracer_, lights_, 200, all(tracer_, lights_));
}

TEST_F(GatherPointCuts, CutsEndByTheErrorAskedFor) {
  settings_.cut.nodes = 1000;
  const std::vector<Rgb> exact = all(tracer_, manyLights_);
  uint64_t lights = 0, missing = 0;  // so far
  const VirtualLights* of = &manyLights_;
  const auto gathered = [&](float error, uint64_t* used, uint64_t* missed) {
    settings_.cut.error = error;
    const double e = relativeError(some(tracer_, *of), exact);
    *used = context_.statistics.count("cut_lights") - lights;
    *missed = context_.statistics.count("error_missed") - missing;
    lights += *used, missing += *missed;
    return e;
  };
  uint64_t whole, coarse, fine, unmet;
  gathered(0, &whole, &unmet);
  EXPECT_EQ(unmet, 0u) << "none asked for";
  const double loose = gathered(0.6f, &coarse, &unmet);
  EXPECT_EQ(unmet, 0u);
  const double tight = gathered(0.2f, &fine, &unmet);
  EXPECT_LT(coarse, fine);
  EXPECT_LT(fine, whole);
  EXPECT_LT(tight, loose);
  uint64_t most;
  gathered(1e-4f, &most, &unmet);
  EXPECT_EQ(most, whole) << "all nodes that there may be";
  EXPECT_GT(unmet, 0u);
  of = &lights_;
  settings_.cut.nodes = 200;
  gathered(0, &whole, &unmet);
  gathered(1, &coarse, &unmet);
  EXPECT_LT(coarse, whole);
  expectUnbiased(tracer_, lights_, 300, all(tracer_, lights_));
}

TEST_F(GatherPointCuts, EveryClassAlone) {
  settings_.cut.nodes = 40;
  settings_.gather.clamp = 3;
  for (const LightClass lightClass :
       {LightClass::omni, LightClass::directional, LightClass::diffuse, LightClass::glossy}) {
    SCOPED_TRACE(static_cast<int>(lightClass));
    VirtualLights one = lights_;
    if (lightClass != LightClass::omni) one.omni.clear();
    if (lightClass != LightClass::directional) one.directional.clear();
    if (lightClass != LightClass::diffuse) one.diffuse.clear(), one.diffuseDepthEnds.clear();
    if (lightClass != LightClass::glossy) one.glossy.clear(), one.glossyDepthEnds.clear();
    expectUnbiased(tracer_, one, 200, all(tracer_, one));
  }
}

// Where nothing hides anything, one ray says as much as many. No light matters much alone.
TEST_F(GatherPointCuts, SharedRaysChangeVisibilityOnly) {
  Scene empty = randomTriangles(1, 1);
  for (Vec3f& p : empty.meshes[0].positions) p += Vec3f(50.f);
  const Tracer open(empty, context_);
  // A small patch of floor and of wall.
  for (ReceiverPoint& point : receivers_.points) {
    point.p *= 0.001f;
    face(&point, point.pixel % 2 == 1 ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1});
  }
  const Traced own = traced(open, false), shared = traced(open, true);
  expectEqual(shared.light, own.light);  // nothing hides anything
  EXPECT_LT(2 * shared.rays, own.rays) << "by one of many";
  EXPECT_NE(traced(tracer_, true).light, own.light);
  for (ReceiverPoint& point : receivers_.points) point.pixel *= 100 * kWidth;
  expectEqual(traced(tracer_, true).light, traced(tracer_, false).light);  // only neighbours share
}

// An edge right above the floor hides all lights from the receivers on one side of it.
TEST_F(GatherPointCuts, ReceiversThatSeeUnlikeHaveRaysOfTheirOwn) {
  Scene edge = randomTriangles(1, 1);
  edge.meshes[0].positions = {{0, -9, 1e-4f}, {0, 9, 1e-4f}, {-9, 0, 1e-4f}};
  const Tracer tracer(edge, context_);
  for (ReceiverPoint& point : receivers_.points) {
    point.p = {2e-3f * static_cast<float>(point.pixel % kWidth) - 0.0171f,
               2e-3f * static_cast<float>(point.pixel / kWidth), 0};
    face(&point, {0, 0, 1});
  }
  const Traced own = traced(tracer, false), shared = traced(tracer, true);
  EXPECT_LT(relativeError(shared.light, own.light), 0.01);
  EXPECT_LT(3 * shared.rays, 2 * own.rays) << "clusters beside the edge share theirs";
}

// As filters have.
TEST_F(GatherPointCuts, WeightsMayBeNegative) {
  settings_.cut.nodes = 50;
  const std::vector<Rgb> light = some(tracer_, lights_);
  for (ReceiverPoint& point : receivers_.points) point.weight *= -1.f;
  const std::vector<Rgb> negative = some(tracer_, lights_);
  EXPECT_GT(sum(light), 0);
  for (size_t i = 0; i < light.size(); ++i) EXPECT_EQ(negative[i], -1.f * light[i]) << i;
}

TEST_F(GatherPointCuts, ThreadsDoNotMatter) {
  settings_.cut.nodes = 50;
  settings_.shared = true;
  const std::vector<Rgb> many = some(tracer_, lights_);
  const ThreadLimit limit(1);
  EXPECT_EQ(some(tracer_, lights_), many);
  settings_.seed = 1;
  EXPECT_NE(some(tracer_, lights_), many);
}

TEST_F(GatherPointCuts, OnePixelAloneHasTheSameBits) {
  const std::vector<Rgb> whole = some(tracer_, lights_), one = some(tracer_, lights_, nullptr, 37);
  EXPECT_EQ(one[37], whole[37]);
  EXPECT_NE(one[37], Rgb{});
  EXPECT_LE(std::count_if(one.begin(), one.end(), [](Rgb v) { return v != Rgb{}; }), kStrip);
}

TEST_F(GatherPointCuts, PartsAddUp) {
  settings_.cut.nodes = 64;
  expectPartsAddUp(lights_, context_,
                   [&](GatherParts* parts) { return some(tracer_, lights_, parts); });
}

// Suns at the horizon: where they stand must not decide what they light.
TEST_F(GatherPointCuts, GrazingDirectionalLights) {
  VirtualLights suns;
  for (int i = 0; i < 64; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / 64;
    suns.directional.push_back(
        {normalize(Vec3f{std::cos(angle), std::sin(angle), 0.004f}), Rgb(1.f)});
  }
  for (ReceiverPoint& point : receivers_.points) {
    point.frame = frameFromNormal({0, 0, 1});
    point.ng = {0, 0, 1};
  }
  expectEqual(some(tracer_, suns), all(tracer_, suns));
}

TEST_F(GatherPointCuts, NoLightsNoReceivers) {
  EXPECT_EQ(sum(some(tracer_, {})), 0);
  receivers_ = {};
  EXPECT_TRUE(some(tracer_, lights_).empty());
}

// Directions are drawn by what the points of a strip have in common, so the sum over all lights in
// the same clusters is what the mean must be.
TEST_P(GatherSphericalCuts, MeanOverSeedsIsTheLightOfAll) {
  settings_.cut.nodes = kLights;
  const std::vector<Rgb> whole = some(floor_.tracer(), floor_.lights());
  const double exact = sum(all(floor_.tracer(), floor_.lights()));
  EXPECT_NEAR(sum(whole), exact, 0.03 * exact);
  settings_.cut.nodes = 200;
  expectUnbiased(floor_.tracer(), floor_.lights(), 300, whole);
}

INSTANTIATE_TEST_SUITE_P(Materials, GatherSphericalCuts,
                         testing::Values(phongMaterial(0.8f, 0, 1), phongMaterial(0.2f, 0.6f, 200),
                                         roughMetal(Distribution::ggx, 0.2f, 0.2f),
                                         wardMaterial(0.05f, 0.3f)));

// Neighbours in the picture that are far apart in the scene, or turned away, share no rays.
TEST_F(GatherCuts, EdgesAreNotCompact) {
  const auto compact = [&](float depth, float turn) {
    Receivers receivers = randomReceivers(16, {LobeType::lambert}, 1, 3);
    for (uint32_t i = 0; i < 16; ++i) {
      const Vec2f place{static_cast<float>(i % 4), static_cast<float>(i / 4)};
      receivers.points[i].pixel = i % 4 + i / 4 * kWidth;
      receivers.points[i].p = {0.001f * place.x, 0.001f * place.y, i % 4 < 2 ? depth : 0};
      receivers.points[i].frame = frameFromNormal(normalize(Vec3f{i % 4 < 2 ? turn : 0, 0, 1}));
    }
    const ReceiverClusters clusters = clusterReceivers(receivers, 2, kWidth);
    EXPECT_EQ(clusters.clusters.size(), 1u);
    return clusters.clusters[0].compact;
  };
  EXPECT_TRUE(compact(0, 0));
  EXPECT_TRUE(compact(0.01f, 0.1f));
  EXPECT_FALSE(compact(0.1f, 0));
  EXPECT_FALSE(compact(0, 2));
}

TEST_F(GatherCuts, ClustersHoldEveryReceiverOnce) {
  receivers_.points[5].lobeCount = 0;
  const ReceiverClusters clusters = clusterReceivers(receivers_, 2, kWidth);
  std::vector<int> seen(receivers_.points.size(), 0);
  for (const ReceiverClusters::Cluster& cluster : clusters.clusters) {
    ASSERT_LT(cluster.begin, cluster.end);
    ASSERT_LE(cluster.end - cluster.begin, static_cast<uint32_t>(kStrip));
    const LobeKinds kinds = kindsOf(receivers_, receivers_.points[clusters.order[cluster.begin]]);
    for (uint32_t i = cluster.begin; i < cluster.end; ++i) {
      const ReceiverPoint& point = receivers_.points[clusters.order[i]];
      EXPECT_EQ(kindsOf(receivers_, point), kinds);
      EXPECT_EQ(clusters.receivers.points[i].pixel, point.pixel);
      ++seen[clusters.order[i]];
    }
    EXPECT_EQ(makeTile(clusters.receivers, cluster.begin, cluster.end).strips.size(), 1u);
  }
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i == 5 ? 0 : 1);
}

}  // namespace
}  // namespace lobelia
