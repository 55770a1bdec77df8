// Bi-tree gathering against the sum over all lights.
#include "lobelia/gather/gather_pairs.h"

#include <limits>

#include "gather/random_input.h"
#include "gather/spherical_setup.h"
#include "gather/strategy_test.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

class GatherPairs : public testing::Test {
 protected:
  GatherPairs() { settings_.gather.direct = true; }
  std::vector<Rgb> all(const Tracer& tracer, const VirtualLights& lights) {
    return lightOfAll(tracer, receivers_, lights, settings_.gather, context_);
  }
  std::vector<Rgb> pairs(const Tracer& tracer, const VirtualLights& lights,
                         GatherParts* parts = nullptr) {
    return lightOf(LightPairs(tracer, lights, settings_, context_), receivers_, context_, parts);
  }
  uint64_t count(const char* name) const { return context_.statistics.count(name); }
  // What a count grows by.
  template <class F>
  uint64_t growth(const char* name, const F& f) {
    const uint64_t before = count(name);
    f();
    return count(name) - before;
  }

  Receivers receivers_ =
      randomReceivers(300, {LobeType::lambert, LobeType::phong, LobeType::ward}, 1, 3);
  PairGatherSettings settings_;
  Context context_;
  Scene scene_ = randomTriangles(60, 11);
  Tracer tracer_{scene_, context_};
  VirtualLights lights_ = randomLights(150, 100.f, 5);
};

// Neighbours in a corner, lit by a wall of lights.
class GatherPairsOfWalls : public GatherPairs {
 protected:
  GatherPairsOfWalls() {
    for (Vec3f& p : scene_.meshes[0].positions) p = p * 0.2f + Vec3f{0, 0, 0.5f};
    Rng rng(5);
    for (ReceiverPoint& point : receivers_.points) {
      point.p = {rng.next1D(), rng.next1D(), 0};
      point.frame = frameFromNormal({0, 0, 1});
      point.ng = {0, 0, 1};
      point.wo = normalize(Vec3f{0.3f, 0.2f, 1} + randomPoint(&rng, 0.05f));
      point.weight = Rgb(1.f);
    }
    VirtualLights wall;
    for (int i = 0; i < 3000; ++i) {
      const Vec3f p{-0.3f, rng.next1D(), 0.2f + rng.next1D()}, n{1, 0, 0};
      const Rgb color = randomColor(&rng);
      if (i % 2 == 0) {
        wall.diffuse.push_back({p, color, encodeOctahedral(n), 1});
      } else {
        const Vec3f axis = normalize(Vec3f{1, 0.1f, -0.8f} + randomPoint(&rng, 0.2f));
        wall.glossy.push_back({p, n, axis, color * 10.f, 20 + 30 * rng.next1D()});
      }
    }
    wall.diffuseDepthEnds = wall.glossyDepthEnds = {0, 1500};
    lights_ = wall;
  }
};

TEST_F(GatherPairs, ThresholdZeroIsTheSum) {
  settings_.threshold = 0;
  settings_.gather.clamp = 3;
  const std::vector<Rgb> exact = all(tracer_, lights_);
  EXPECT_GT(sum(exact), 0);
  expectEqual(pairs(tracer_, lights_), exact);
  settings_.share = Share::radiance;
  expectEqual(pairs(tracer_, lights_), exact);
  settings_.traversal.children = TraversalSettings::ChildRule::paper;
  expectEqual(pairs(tracer_, lights_), exact);
}

TEST_F(GatherPairs, ThresholdZeroOfEveryClassAlone) {
  settings_.threshold = 0;
  for (const LightClass lightClass :
       {LightClass::omni, LightClass::directional, LightClass::diffuse, LightClass::glossy}) {
    SCOPED_TRACE(static_cast<int>(lightClass));
    VirtualLights one = lights_;
    if (lightClass != LightClass::omni) one.omni.clear();
    if (lightClass != LightClass::directional) one.directional.clear();
    if (lightClass != LightClass::diffuse) one.diffuse.clear(), one.diffuseDepthEnds.clear();
    if (lightClass != LightClass::glossy) one.glossy.clear(), one.glossyDepthEnds.clear();
    const std::vector<Rgb> exact = all(tracer_, one);
    EXPECT_GT(sum(exact), 0);
    expectEqual(pairs(tracer_, one), exact);
  }
}

// Lights whose directions have a pattern stand for themselves, at any threshold.
TEST_F(GatherPairs, SpotsKeepTheirPattern) {
  Emitter spot;
  spot.type = EmitterType::spot;
  spot.cutoff = 1.2f;
  spot.beamWidth = 0.3f;
  scene_.emitters = {spot};
  const Tracer tracer(scene_, context_);
  VirtualLights spots;
  Rng rng(2);
  for (int i = 0; i < 40; ++i) spots.omni.push_back({randomPoint(&rng, 1), randomColor(&rng), 0});
  settings_.threshold = 0.5f;
  const std::vector<Rgb> exact = all(tracer, spots);
  EXPECT_GT(sum(exact), 0);
  expectEqual(pairs(tracer, spots), exact);
}

// One ray must not decide about a sun's shadow for many receivers.
TEST_F(GatherPairsOfWalls, ShadowsOfSunsAreSharp) {
  const Tracer tracer(scene_, context_);
  VirtualLights sun;
  sun.directional.push_back({normalize(Vec3f{-0.8f, -0.8f, 1}), Rgb(1.f)});
  settings_.threshold = 0.02f;
  const std::vector<Rgb> exact = all(tracer, sun);
  EXPECT_GT(std::count(exact.begin(), exact.end(), Rgb{}), 10) << "in shadow";
  expectEqual(pairs(tracer, sun), exact);
}

// Each lobe in a tree of its own, and depths that see fewer lights.
TEST_F(GatherPairs, ThresholdZeroOfSeveralLobesAndDepths) {
  receivers_ = randomReceivers(200,
                               {LobeType::lambert, LobeType::phong, LobeType::microfacetReflection,
                                LobeType::microfacetTransmission, LobeType::diffuseTransmission},
                               3, 9);
  settings_.threshold = 0;
  expectEqual(pairs(tracer_, lights_), all(tracer_, lights_));
  settings_.gather.clamp = 0.5f;
  expectEqual(pairs(tracer_, lights_), all(tracer_, lights_));
  settings_.share = Share::radiance;
  settings_.gather.maxDepth = 4;
  settings_.gather.direct = false;
  const std::vector<Rgb> exact = all(tracer_, lights_);
  EXPECT_GT(sum(exact), 0);
  expectEqual(pairs(tracer_, lights_), exact);
}

TEST_F(GatherPairs, EachLightAndReceiverOnce) {
  const uint64_t whole = receivers_.points.size() * lights_.size();
  for (const float threshold : {0.f, 0.01f, 0.3f})
    for (const auto rule :
         {TraversalSettings::ChildRule::extent, TraversalSettings::ChildRule::paper}) {
      settings_.threshold = threshold;
      settings_.traversal.children = rule;
      EXPECT_EQ(growth("clustered_lights", [&] { pairs(tracer_, lights_); }), whole);
    }
}

// Filters weight samples below 0, too: their bounds are those of their size.
TEST_F(GatherPairsOfWalls, WeightsMayBeNegative) {
  const Tracer tracer(scene_, context_);
  for (ReceiverPoint& point : receivers_.points)
    if (point.p.x < 0.5f) point.weight = Rgb(-0.1f);
  settings_.threshold = 0.01f;
  std::vector<Rgb> exact = all(tracer, lights_), light = pairs(tracer, lights_);
  for (size_t i = 0; i < exact.size(); ++i)
    if (receivers_.points[i].weight.x > 0) exact[i] = light[i] = {};
  EXPECT_LT(sum(exact), 0);
  EXPECT_LT(relativeError(light, exact), 0.005);
}

TEST_F(GatherPairsOfWalls, SmallerThresholdsComeNearer) {
  const Tracer tracer(scene_, context_);
  const std::vector<Rgb> exact = all(tracer, lights_);
  double error = 1;
  uint64_t rays = 0;
  for (const float threshold : {0.2f, 0.05f, 0.01f}) {
    settings_.threshold = threshold;
    std::vector<Rgb> light;
    const uint64_t more = growth("shadow_rays", [&] { light = pairs(tracer, lights_); });
    EXPECT_LT(relativeError(light, exact), 0.8 * error) << threshold;
    EXPECT_GT(more, rays) << threshold;
    error = relativeError(light, exact), rays = more;
  }
  EXPECT_LT(error, 0.02);
  EXPECT_LT(rays, receivers_.points.size() * lights_.size() / 2);
}

TEST_F(GatherPairsOfWalls, SettingsDoWhatTheySay) {
  const Tracer tracer(scene_, context_);
  const std::vector<Rgb> exact = all(tracer, lights_);
  settings_.threshold = 0.05f;
  const auto rays = [&] { return growth("shadow_rays", [&] { pairs(tracer, lights_); }); };
  const uint64_t before = rays();
  const double error = relativeError(pairs(tracer, lights_), exact);
  settings_.share = Share::radiance;
  EXPECT_NEAR(static_cast<double>(rays()), static_cast<double>(before),
              0.2 * static_cast<double>(before))
      << "about the same pairs";
  EXPECT_GT(relativeError(pairs(tracer, lights_), exact), 1.2 * error) << "copied to neighbours";
  settings_.share = Share::visibility;
  settings_.traversal.error = TraversalSettings::Error::conservative;
  EXPECT_GT(rays(), before);
  settings_.traversal.error = TraversalSettings::Error::approximate;
  settings_.traversal.bounds = BoundForm::corrected;
  EXPECT_GT(rays(), before);
}

TEST_F(GatherPairsOfWalls, ThreadsDoNotMatter) {
  const Tracer tracer(scene_, context_);
  settings_.threshold = 0.05f;
  const std::vector<Rgb> many = pairs(tracer, lights_);
  const ThreadLimit limit(1);
  EXPECT_EQ(pairs(tracer, lights_), many);
  settings_.seed = 1;
  EXPECT_NE(pairs(tracer, lights_), many);
}

TEST_F(GatherPairs, PartsAddUp) {
  settings_.threshold = 0.1f;
  lights_.groups = {"a", "b"};
  lights_.omniGroups.assign(lights_.omni.size(), 1);
  GatherParts parts;
  parts.groupCount = 2, parts.byType = true, parts.countRays = true;
  const std::vector<Rgb> whole = pairs(tracer_, lights_, &parts);
  EXPECT_EQ(pairs(tracer_, lights_), whole);
  const size_t n = whole.size();
  uint64_t rays = 0;
  Rgb omni;
  for (size_t i = 0; i < n; ++i) {
    Rgb types;
    for (size_t t = 0; t < GatherParts::kTypes; ++t) types += parts.types[t * n + i];
    const Rgb groups = parts.groups[i] + parts.groups[n + i];
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(types[c], whole[i][c], 1e-4f * whole[i][c] + 1e-9f);
      EXPECT_NEAR(groups[c], whole[i][c], 1e-4f * whole[i][c] + 1e-9f);
      EXPECT_NEAR(parts.groups[n + i][c], (parts.types[i] + parts.types[n + i])[c],
                  1e-4f * whole[i][c] + 1e-9f);
    }
    rays += parts.rays[i];
    omni += parts.groups[n + i];
  }
  EXPECT_GT(omni.x, 0);
  EXPECT_EQ(2 * rays, count("shadow_rays"));
}

// Few receivers of a node face the lights: whatever is drawn, they are lit.
TEST_F(GatherPairs, HorizonsAreNotDark) {
  Rng rng(8);
  for (ReceiverPoint& point : receivers_.points) {
    const Vec3f n = point.pixel % 20 == 0 ? Vec3f{0, 0, 1} : Vec3f{0, 0, -1};
    point.p = randomPoint(&rng, 0.01f);
    point.frame = frameFromNormal(n);
    point.ng = n, point.wo = n;
    point.weight = Rgb(1.f);
    receivers_.lobes[point.firstLobe] = Lobe{};
    receivers_.lobes[point.firstLobe].weight = Rgb(0.5f);
  }
  VirtualLights above;
  for (int i = 0; i < 200; ++i)
    above.diffuse.push_back({Vec3f{0, 0, 5} + randomPoint(&rng, 0.05f), randomColor(&rng),
                             encodeOctahedral({0, 0, -1}), 0});
  above.diffuseDepthEnds = {200};
  const Scene empty;
  const Tracer tracer(empty, context_);
  const std::vector<Rgb> exact = all(tracer, above);
  const LightForest lights = plantLights(above, settings_.gather, 1, empty, tracer.bounds(), {});
  ASSERT_EQ(lights.trees.size(), 1u);
  const ReceiverForest receivers = plantReceivers(receivers_, 1, false, false);
  const PreparedLights none;
  // A pair of nodes per tile, all of whose light is wanted, or none of it.
  const auto lit = [&](float threshold, uint64_t seed) {
    const PairScene scene{tracer, above, none, Share::visibility, 0, seed};
    std::vector<Rgb> light;
    for (const ReceiverForest::Tree& tree : receivers.trees) {
      for (const uint32_t tile : tree.tiles) {
        PairShading shading(scene, tree, tile);
        std::vector<TreePair> pair{{tile, 0}};
        const uint32_t count = tree.tree.nodes()[tile].count;
        shading.add(lights.trees[0], &pair, std::vector<float>(2 * count - 1, threshold));
        for (uint32_t i = 0; i < count; ++i) light.push_back(shading.radiance(i));
      }
    }
    return sum(light);
  };
  double unsplit = 0;
  for (uint64_t seed = 0; seed < 10; ++seed) {
    EXPECT_NEAR(lit(0, seed), sum(exact), 0.02 * sum(exact)) << seed;
    unsplit += lit(1e30f, seed) / 10;
  }
  EXPECT_LT(unsplit, 0.8 * sum(exact)) << "few draws find ends that face each other";
}

// Shadow rays go to lights that matter.
TEST_F(GatherPairs, LightsOfANodeAreDrawnByPower) {
  Scene empty;
  Bounds3f bounds;
  bounds.add(Vec3f(-1.f)), bounds.add(Vec3f(1.f));
  const LightForest forest = plantLights(lights_, settings_.gather, 1, empty, bounds, {});
  constexpr uint64_t kDraws = 100000;
  for (const LightForest::Tree& tree : forest.trees) {
    std::vector<double> drawn(tree.lights.size());
    for (uint64_t i = 0; i < kDraws; ++i) drawn[lightOf(tree, 0, hashCombine(3, i))] += 1;
    for (const trees::BoundNode& node : tree.tree.nodes()) {
      if (!node.leaf()) continue;
      const uint32_t light = tree.lights[node.first];
      const double expected = double{kDraws} *
                              double{luminance(lightPower(lights_, tree.lightClass, light))} /
                              double{luminance(tree.power[0])};
      EXPECT_NEAR(drawn[light], expected, 5 * std::sqrt(expected) + 1);
    }
  }
}

TEST_F(GatherPairs, TheFirstBadPixelIsKnown) {
  settings_.threshold = 0;
  std::vector<uint32_t> lit;
  const std::vector<Rgb> exact = all(tracer_, lights_);
  for (uint32_t i = 0; i < exact.size(); ++i)
    if (luminance(exact[i]) > 0) lit.push_back(i);
  ASSERT_GT(lit.size(), 60u);
  for (const uint32_t pixel : {lit[50], lit[30]})
    receivers_.lobes[receivers_.points[pixel].firstLobe].weight =
        Rgb(std::numeric_limits<float>::quiet_NaN());
  for (const Share share : {Share::visibility, Share::radiance}) {
    settings_.share = share;
    context_.statistics.setValue("first_nonfinite_pixel", 0);
    pairs(tracer_, lights_);
    EXPECT_GT(count("nonfinite"), 0u);
    EXPECT_EQ(context_.statistics.value("first_nonfinite_pixel"), 1.0 + lit[30]);
  }
}

TEST_F(GatherPairs, NothingWhenCancelled) {
  context_.cancel();
  EXPECT_EQ(sum(pairs(tracer_, lights_)), 0);
}

TEST_F(GatherPairs, NoLightsNoReceivers) {
  EXPECT_EQ(sum(pairs(tracer_, {})), 0);
  receivers_ = {};
  EXPECT_TRUE(pairs(tracer_, lights_).empty());
}

// Spherical lights: brute force draws their directions by what a strip has in common, which are
// other strips there.
class GatherSphericalPairs : public GatherPairs, public testing::WithParamInterface<Material> {};

TEST_P(GatherSphericalPairs, AreNearTheSum) {
  LitFloor floor(GetParam(), 0.3f, {0.2f, 0, 1});
  Rng random(4);
  std::vector<SphericalLight>& spheres = floor.lights().spherical;
  const SphericalLight light = spheres[0];
  spheres.clear();
  for (int i = 0; i < 600; ++i) {
    SphericalLight l = light;
    const Vec2f u = random.next2D();
    l.p = Vec3f(LitFloor::kMiddle) + Vec3f{3 * u.x - 1.5f, 3 * u.y - 1.5f, 0};
    l.radius = 0.05f + 0.1f * random.next1D();
    const Vec2f v = random.next2D();
    l.arriving = encodeOctahedral(normalize(Vec3f{2 * v.x - 1, 2 * v.y - 1, 0.5f}));
    spheres.push_back(l);
  }
  floor.lights().sphericalDepthEnds = {0, 600};
  for (ReceiverPoint& point : receivers_.points) point.p += Vec3f(LitFloor::kMiddle);
  const std::vector<Rgb> exact = all(floor.tracer(), floor.lights());
  settings_.threshold = 0;
  const std::vector<Rgb> leaves = pairs(floor.tracer(), floor.lights());
  EXPECT_NEAR(sum(leaves), sum(exact), 0.02 * sum(exact));
  EXPECT_LT(relativeError(leaves, exact), 0.1);
  settings_.threshold = 0.02f;
  EXPECT_LT(relativeError(pairs(floor.tracer(), floor.lights()), leaves), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Materials, GatherSphericalPairs,
                         testing::Values(phongMaterial(0.8f, 0, 1), phongMaterial(0.2f, 0.6f, 200),
                                         roughMetal(Distribution::ggx, 0.2f, 0.2f)));

}  // namespace
}  // namespace lobelia
