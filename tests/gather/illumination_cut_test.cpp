// IlluminationCut against the sum over all lights.
#include "lobelia/gather/illumination_cut.h"

#include "gather/lit_corner.h"
#include "gather/spherical_setup.h"
#include "gather/strategy_test.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class IlluminationCutGather : public StrategyTest {
 protected:
  std::unique_ptr<PreparedGather> prepare(uint64_t seed) override {
    settings_.gather = gather_;
    settings_.seed = seed;
    return std::make_unique<IlluminationCut>(*use_, lights_, settings_, context_);
  }
  IlluminationCutSettings settings_;
};

class IlluminationCutOfWalls : public IlluminationCutGather {
 protected:
  IlluminationCutOfWalls() {
    receivers_ = randomReceivers(9000, {LobeType::lambert, LobeType::phong}, 1, 3);
    layOnFloor(&receivers_, 5);
    for (size_t i = 0; i < receivers_.points.size(); ++i)
      receivers_.points[i].pixel = static_cast<uint32_t>(i);
    lights_ = wallOfLights(2000, 5);
    gather_.clamp = 0;
    use_ = &corner_;
  }
  Scene triangles_ = trianglesAboveFloor();
  Tracer corner_{triangles_, context_};
};

TEST_F(IlluminationCutGather, ThresholdZeroIsTheSum) {
  settings_.threshold = 0;
  expectEqual(some(), all());
  gather_.clamp = 0;
  gather_.maxDepth = 4;
  expectEqual(some(), all());
}

TEST_F(IlluminationCutGather, ThresholdZeroOfSeveralLobesAndDepths) {
  receivers_ = randomReceivers(200,
                               {LobeType::lambert, LobeType::phong, LobeType::microfacetReflection,
                                LobeType::microfacetTransmission, LobeType::diffuseTransmission},
                               3, 9);
  settings_.threshold = 0;
  gather_.maxDepth = 4;
  gather_.direct = false;
  expectEqual(some(), all());
}

// Every class of lights by itself keeps to the sum where lights stand for others, too.
TEST_F(IlluminationCutGather, EveryClassAlone) {
  settings_.threshold = 0.01;
  withEveryClassAlone([&] { EXPECT_LT(relativeError(some(), all()), 0.03); });
}

// Lights whose directions have a pattern stand for themselves, at any threshold.
TEST_F(IlluminationCutGather, SpotsKeepTheirPattern) {
  Emitter spot;
  spot.type = EmitterType::spot;
  spot.cutoff = 1.2f;
  spot.beamWidth = 0.3f;
  scene_.emitters = {spot};
  const Tracer tracer(scene_, context_);
  use_ = &tracer;
  lights_ = {};
  Rng rng(2);
  for (int i = 0; i < 40; ++i) lights_.omni.push_back({randomPoint(&rng, 1), randomColor(&rng), 0});
  settings_.threshold = 0.5;
  expectEqual(some(), all());
}

TEST_F(IlluminationCutOfWalls, SmallerThresholdsComeNearer) {
  const std::vector<Rgb> exact = all();
  double error = 1;
  uint64_t rays = 0;
  for (const double threshold : {0.1, 0.02, 0.004}) {
    settings_.threshold = threshold;
    std::vector<Rgb> light;
    const uint64_t more = growth("shadow_rays", [&] { light = some(); });
    EXPECT_LT(relativeError(light, exact), 0.8 * error) << threshold;
    EXPECT_NEAR(sum(light), sum(exact), 0.05 * sum(exact)) << threshold;
    EXPECT_GT(more, rays) << threshold;
    error = relativeError(light, exact), rays = more;
  }
  EXPECT_LT(error, 0.03);
  EXPECT_LT(rays, receivers_.points.size() * lights_.size() / 3);
}

TEST_F(IlluminationCutOfWalls, FewRaysDoForManyReceivers) {
  settings_.threshold = 0.02;
  const std::vector<Rgb> exact = all();
  std::vector<Rgb> few, full;
  const uint64_t fewRays = growth("shadow_rays", [&] { few = some(); });
  settings_.sampled = false;
  const uint64_t fullRays = growth("shadow_rays", [&] { full = some(); });
  EXPECT_LT(fewRays, fullRays * 4 / 5);
  EXPECT_LT(relativeError(few, exact), 2 * relativeError(full, exact) + 0.01);
  EXPECT_FALSE(few == full);
}

// No bound is 0 where all face each other, and under a low clamp every light of a node sends the
// same: the sum of a receiver says that each is in one pair with it.
TEST_F(IlluminationCutOfWalls, EachLightAndReceiverOnce) {
  for (Lobe& lobe : receivers_.lobes) lobe = Lobe{}, lobe.weight = Rgb(0.5f);
  lights_.glossy.clear(), lights_.glossyDepthEnds.clear();
  for (DiffuseLight& light : lights_.diffuse) light.intensity = Rgb(1.f);
  const Tracer open(Scene{}, context_);
  use_ = &open;
  gather_.clamp = 1e-6f;
  const uint64_t whole = receivers_.points.size() * lights_.size();
  for (const double threshold : {0.0, 0.01, 0.3}) {
    SCOPED_TRACE(threshold);
    settings_.threshold = threshold;
    std::vector<Rgb> light;
    uint64_t covered = 0;
    const uint64_t shaded = growth(
        "cut_lights", [&] { covered = growth("clustered_lights", [&] { light = some(); }); });
    EXPECT_EQ(covered, whole);
    EXPECT_EQ(shaded<whole, threshold> 0) << "lights stand for others";
    for (const Rgb value : light)
      EXPECT_NEAR(value.x, 1e-6f * static_cast<float>(lights_.size()), 1e-8f);
  }
}

// Spherical lights: where bounds underflow, lobes have tails.
TEST_F(IlluminationCutGather, ThresholdZeroOfSphericalLights) {
  LitFloor floor(roughMetal(Distribution::ggx, 0.02f, 0.02f), 0.1f, {0.2f, 0, 1});
  use_ = &floor.tracer();
  lights_ = floor.lights();
  Bsdf plain;
  plain.add(Lobe{});
  receivers_ = LitFloor::receivers({1.5f, 0.3f, 0.5f}, {0, 0, -1}, {0.4f, 0.3f, -1}, plain, 48);
  settings_.threshold = 0;
  const std::vector<Rgb> exact = all();
  EXPECT_GT(sum(exact), 0);
  EXPECT_LT(relativeError(some(), exact), 0.1);
}

// With one light below a node the node's light is that of all; in the mean over representatives
// the cut has the sum's light.
TEST_F(IlluminationCutOfWalls, IsUnbiasedOverRepresentativesWithAllRays) {
  lights_ = wallOfLights(150, 5);
  receivers_.points.resize(1500);
  settings_.threshold = 0.05;
  settings_.sampled = false;
  expectUnbiased(all(), 60, [&](uint64_t draw) { return some(draw); });
}

TEST_F(IlluminationCutOfWalls, ThreadsDoNotMatterAndSeedsDo) {
  settings_.threshold = 0.05;
  expectSameForAnyThreads();
}

TEST_F(IlluminationCutGather, PartsAddUp) {
  settings_.threshold = 0.05;
  expectPartsAddUp();
}

TEST_F(IlluminationCutGather, NothingWhenCancelled) {
  context_.cancel();
  EXPECT_EQ(sum(some()), 0);
}

TEST_F(IlluminationCutGather, NoLightsNoReceivers) {
  lights_ = {};
  EXPECT_EQ(sum(some()), 0);
  receivers_ = {};
  EXPECT_TRUE(some().empty());
}

}  // namespace
}  // namespace lobelia
