#include <gtest/gtest.h>

#include <algorithm>

#include "gather/oracle.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"

namespace lobelia {
namespace {

using namespace test;

class GatherAll : public testing::Test {
 protected:
  std::vector<Rgb> gather(const Receivers& receivers, const VirtualLights& lights,
                          const GatherSettings& settings) {
    std::vector<Rgb> radiance(receivers.points.size());
    gatherAll(tracer_, receivers, lights, settings, radiance, context_);
    return radiance;
  }
  // Relative to the point's own value.
  void expectOracle(const Receivers& receivers, const VirtualLights& lights,
                    const GatherSettings& settings) {
    const std::vector<Rgb> radiance = gather(receivers, lights, settings);
    const Oracle oracle(tracer_, receivers, lights, settings);
    size_t lit = 0;
    for (size_t i = 0; i < radiance.size(); ++i) {
      const Vec3d expected = oracle.radiance(i);
      lit += maxComponent(expected) > 0;
      const double tolerance = 1e-4 * maxComponent(expected) + 1e-30;
      EXPECT_NEAR(double{radiance[i].x}, expected.x, tolerance) << "point " << i;
      EXPECT_NEAR(double{radiance[i].y}, expected.y, tolerance) << "point " << i;
      EXPECT_NEAR(double{radiance[i].z}, expected.z, tolerance) << "point " << i;
    }
    EXPECT_GT(lit, radiance.size() / 15) << "the scene tests too little";
  }

  // Of how many points less than this share is left; none has more.
  static size_t darkened(const std::vector<Rgb>& before, const std::vector<Rgb>& after,
                         float share) {
    size_t count = 0;
    for (size_t i = 0; i < before.size(); ++i) {
      EXPECT_LE(after[i].x, before[i].x * 1.00001f);
      count += after[i].x < share * before[i].x;
    }
    return count;
  }

  Scene scene_ = randomTriangles(60, 11);
  Context context_;
  Tracer tracer_{scene_, context_};
};

struct LobeCase {
  const char* name;
  std::vector<LobeType> types;
  size_t lobesPerPoint;
};

class GatherLobes : public GatherAll, public testing::WithParamInterface<LobeCase> {};

TEST_P(GatherLobes, EqualOracle) {
  const LobeCase& c = GetParam();
  const Receivers receivers = randomReceivers(150, c.types, c.lobesPerPoint, 3);
  GatherSettings settings;
  settings.direct = true;
  expectOracle(receivers, randomLights(50, 1e4f, 5), settings);
}

INSTANTIATE_TEST_SUITE_P(
    Types, GatherLobes,
    testing::Values(LobeCase{"lambert", {LobeType::lambert}, 1},
                    LobeCase{"coatedDiffuse", {LobeType::coatedDiffuse}, 1},
                    LobeCase{"principledDiffuse", {LobeType::principledDiffuse}, 1},
                    LobeCase{"microfacetReflection", {LobeType::microfacetReflection}, 1},
                    LobeCase{"microfacetTransmission", {LobeType::microfacetTransmission}, 1},
                    LobeCase{"phong", {LobeType::phong}, 1}, LobeCase{"ward", {LobeType::ward}, 1},
                    LobeCase{"diffuseTransmission", {LobeType::diffuseTransmission}, 1},
                    LobeCase{"sheen", {LobeType::sheen}, 1},
                    LobeCase{"thinTransmission", {LobeType::thinTransmission}, 1},
                    LobeCase{"mixtures",
                             {LobeType::lambert, LobeType::coatedDiffuse,
                              LobeType::microfacetReflection, LobeType::phong, LobeType::ward,
                              LobeType::diffuseTransmission, LobeType::microfacetTransmission},
                             3}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(GatherAll, ClampLimitsGeometryTimesLobes) {
  const Receivers receivers =
      randomReceivers(100, {LobeType::lambert, LobeType::microfacetReflection}, 2, 7);
  const VirtualLights lights = randomLights(60, 100.f, 8);
  GatherSettings settings;
  settings.direct = true;
  settings.clamp = 0.2f;
  expectOracle(receivers, lights, settings);
  const std::vector<Rgb> clamped = gather(receivers, lights, settings);
  settings.clamp = 0;
  const std::vector<Rgb> whole = gather(receivers, lights, settings);
  EXPECT_GT(darkened(whole, clamped, 0.99f), whole.size() / 4);
}

// Of what is near, receivers gather a share only.
TEST_F(GatherAll, NearLightsCountBySharesThatGrowWithTheDistance) {
  Receivers receivers =
      randomReceivers(100, {LobeType::lambert, LobeType::microfacetReflection}, 2, 7);
  const VirtualLights lights = randomLights(60, 100.f, 8);
  GatherSettings settings;
  settings.direct = true;
  const std::vector<Rgb> whole = gather(receivers, lights, settings);
  Rng rng(3);
  for (ReceiverPoint& point : receivers.points)
    if (rng.next1D() < 0.8f) point.nearDistance = 2 * rng.next1D();
  expectOracle(receivers, lights, settings);
  const std::vector<Rgb> far = gather(receivers, lights, settings);
  EXPECT_GT(darkened(whole, far, 0.9f), whole.size() / 8);
}

TEST_F(GatherAll, DepthLimitCountsEyeAndLightEdges) {
  const Receivers receivers = randomReceivers(70, {LobeType::lambert}, 1, 9);
  const VirtualLights lights = randomLights(90, 10.f, 10);
  for (const bool direct : {false, true}) {
    for (const int maxDepth : {-1, 3, 4, 5}) {
      GatherSettings settings;
      settings.direct = direct;
      settings.maxDepth = maxDepth;
      SCOPED_TRACE(maxDepth);
      expectOracle(receivers, lights, settings);
    }
  }
  // A path of receiver and emitter alone has two edges.
  GatherSettings settings;
  settings.direct = true;
  settings.maxDepth = 1;
  for (const Rgb& value : gather(receivers, lights, settings)) EXPECT_EQ(value, Rgb(0.f));
}

TEST_F(GatherAll, SpotsAndProjectorsKeepTheirPattern) {
  Emitter spot;
  spot.type = EmitterType::spot;
  spot.cutoff = 1.2f;
  spot.beamWidth = 0.3f;
  Emitter projector;
  projector.type = EmitterType::projector;
  projector.radiance = Rgb(0.3f, 0.6f, 0.9f);
  projector.fov = 2.f;
  Scene scene = scene_;
  scene.emitters = {spot, projector};
  const Tracer tracer(scene, context_);
  const Receivers receivers = randomReceivers(200, {LobeType::lambert}, 1, 12);
  VirtualLights lights;
  for (uint32_t e = 0; e < 2; ++e) lights.omni.push_back({{0, 0, -2}, Rgb(1.f), e});
  GatherSettings settings;
  settings.direct = true;
  std::vector<Rgb> radiance(receivers.points.size());
  gatherAll(tracer, receivers, lights, settings, radiance, context_);
  const Oracle oracle(tracer, receivers, lights, settings);
  size_t lit = 0;
  for (size_t i = 0; i < radiance.size(); ++i) {
    const Vec3d expected = oracle.radiance(i);
    lit += expected.x > 0;
    EXPECT_NEAR(double{radiance[i].x}, expected.x, 1e-4 * expected.x + 1e-30);
  }
  EXPECT_GT(lit, 30u);
}

TEST_F(GatherAll, SameBitsForAnyNumberOfThreads) {
  const Receivers receivers = randomReceivers(
      700, {LobeType::lambert, LobeType::microfacetReflection, LobeType::phong}, 2, 13);
  const VirtualLights lights = randomLights(100, 1e3f, 14);
  GatherSettings settings;
  settings.direct = true;
  std::vector<std::vector<Rgb>> results;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    results.push_back(gather(receivers, lights, settings));
  }
  EXPECT_GT(maxComponent(results[0][0] + results[0][1] + results[0][2]), 0.f);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST_F(GatherAll, SumsDoNotDependOnTheCompanyInATile) {
  const Receivers receivers =
      randomReceivers(300, {LobeType::lambert, LobeType::phong, LobeType::ward}, 2, 23);
  const VirtualLights lights = randomLights(70, 1e3f, 24);
  GatherSettings settings;
  settings.direct = true;
  const std::vector<Rgb> together = gather(receivers, lights, settings);
  Receivers backwards = receivers;
  std::reverse(backwards.points.begin(), backwards.points.end());
  const std::vector<Rgb> reversed = gather(backwards, lights, settings);
  for (size_t i = 0; i < together.size(); ++i)
    EXPECT_EQ(together[i], reversed[together.size() - 1 - i]) << "point " << i;
}

// A sheet of the given opacity between a light and many receivers: the share of them that is lit.
float litShareBehindMask(float opacity) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  Material mask;
  mask.type = MaterialType::mask;
  mask.a.index = 1;
  mask.opacity = opacity;
  scene.materials = {mask, Material()};
  Instance instance;
  instance.mesh.index = 0;
  instance.material.index = 0;
  scene.instances.push_back(instance);
  Context context;
  const Tracer tracer(scene, context);
  Receivers receivers;
  Rng rng(25);
  for (int i = 0; i < 4000; ++i) {
    ReceiverPoint point;
    const Vec2f at = rng.next2D();
    point.p = {at.x, at.y, 0};
    point.ng = point.wo = {0, 0, 1};
    point.weight = Rgb(1.f);
    point.lobeCount = 1;
    receivers.points.push_back(point);
  }
  receivers.lobes.emplace_back();
  VirtualLights lights;
  lights.omni.push_back({{0, 0, 3}, Rgb(1.f), 0xffffffffu});
  GatherSettings settings;
  settings.direct = true;
  std::vector<Rgb> radiance(receivers.points.size());
  gatherAll(tracer, receivers, lights, settings, radiance, context);
  const auto lit = std::count_if(radiance.begin(), radiance.end(), [](Rgb v) { return v.x > 0; });
  return static_cast<float>(lit) / static_cast<float>(radiance.size());
}

TEST(GatherMasks, LetLightThroughByTheirOpacity) {
  EXPECT_EQ(litShareBehindMask(1.f), 0.f);
  EXPECT_EQ(litShareBehindMask(0.f), 1.f);
  // Five standard deviations of 4000 coins.
  EXPECT_NEAR(litShareBehindMask(0.3f), 0.7f, 0.037f);
}

TEST_F(GatherAll, AddsToRadianceAndCounts) {
  const Receivers receivers = randomReceivers(40, {LobeType::lambert}, 1, 15);
  const VirtualLights lights = randomLights(33, 10.f, 16);
  GatherSettings settings;
  settings.direct = true;
  const std::vector<Rgb> once = gather(receivers, lights, settings);
  const uint64_t rays = context_.statistics.count("shadow_rays");
  const uint64_t pairs = context_.statistics.count("node_pairs_shaded");
  EXPECT_GT(rays, 0u);
  EXPECT_GT(pairs, 0u);
  EXPECT_LE(pairs, rays);
  EXPECT_LE(rays, 40u * lights.size());
  EXPECT_EQ(context_.statistics.count("nonfinite"), 0u);
  std::vector<Rgb> again(once.size(), Rgb(1.f));
  gatherAll(tracer_, receivers, lights, settings, again, context_);
  for (size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i], Rgb(1.f) + once[i]);
  EXPECT_EQ(context_.statistics.count("shadow_rays"), 2 * rays);
}

TEST_F(GatherAll, NonFiniteValuesAreCountedAndLeftOut) {
  Receivers receivers = randomReceivers(20, {LobeType::lambert}, 1, 17);
  for (Lobe& lobe : receivers.lobes) lobe.twoSided = true;
  VirtualLights lights;
  lights.omni.push_back({{0.1f, 0.2f, 1.5f}, Rgb(1.f), 0xffffffffu});
  GatherSettings settings;
  settings.direct = true;
  const std::vector<Rgb> good = gather(receivers, lights, settings);
  ASSERT_EQ(context_.statistics.count("nonfinite"), 0u);
  const uint64_t pairs = context_.statistics.count("node_pairs_shaded");
  ASSERT_GT(pairs, 0u);
  lights.omni.push_back({{0.1f, 0.2f, 1.5f}, Rgb(0.f, 1.f, INFINITY), 0xffffffffu});
  EXPECT_EQ(gather(receivers, lights, settings), good);
  EXPECT_EQ(context_.statistics.count("nonfinite"), pairs);
  // One of them bad, among pixels in no order: the first that sees it.
  Context fresh;
  for (size_t i = 0; i < receivers.points.size(); ++i)
    receivers.points[i].pixel = static_cast<uint32_t>(100 + i * 7 % receivers.points.size());
  uint32_t first = ~0u;
  for (size_t i = 0; i < good.size(); ++i)
    if (good[i] != Rgb(0.f)) first = std::min(first, receivers.points[i].pixel);
  std::vector<Rgb> radiance(good.size());
  gatherAll(tracer_, receivers, lights, settings, radiance, fresh);
  EXPECT_EQ(fresh.statistics.value("first_nonfinite_pixel"), 1.0 + first);
}

TEST_F(GatherAll, ManyLightsSumAccurately) {
  // A hundred thousand equal lights in one place: the sum is that many times one of them.
  Receivers receivers = randomReceivers(16, {LobeType::lambert}, 1, 18);
  for (Lobe& lobe : receivers.lobes) lobe.twoSided = true;
  VirtualLights one, many;
  one.omni.push_back({{0.1f, 0.2f, 1.5f}, Rgb(1.f), 0xffffffffu});
  many.omni.assign(100000, one.omni[0]);
  GatherSettings settings;
  settings.direct = true;
  const std::vector<Rgb> expected = gather(receivers, one, settings);
  const std::vector<Rgb> radiance = gather(receivers, many, settings);
  for (size_t i = 0; i < radiance.size(); ++i)
    EXPECT_NEAR(radiance[i].x, 1e5f * expected[i].x, 1e5f * expected[i].x * 1e-6f);
}

TEST_F(GatherAll, StopsWhenCancelled) {
  const Receivers receivers = randomReceivers(40, {LobeType::lambert}, 1, 19);
  GatherSettings settings;
  settings.direct = true;
  context_.cancel();
  for (const Rgb& value : gather(receivers, randomLights(20, 10.f, 20), settings))
    EXPECT_EQ(value, Rgb(0.f));
}

TEST_F(GatherAll, EmptyInputIsFine) {
  EXPECT_TRUE(gather({}, randomLights(20, 10.f, 21), {}).empty());
  const std::vector<Rgb> dark = gather(randomReceivers(5, {LobeType::lambert}, 1, 22), {}, {});
  for (const Rgb& value : dark) EXPECT_EQ(value, Rgb(0.f));
  EXPECT_THROW(
      gatherAll(tracer_, randomReceivers(5, {LobeType::lambert}, 1, 22), {}, {}, {}, context_),
      std::invalid_argument);
}

// A tile of points of many kinds has more strips than points would fill.
TEST_F(GatherAll, RaysOfManyStrips) {
  using namespace gather;
  const Receivers receivers = randomReceivers(kStrip, {LobeType::lambert}, 1, 3);
  const VirtualLights lights = randomLights(20, 100.f, 5);
  LightBlock block;
  prepare(lights, scene_, LightClass::diffuse, 0, 20, &block);
  Tile tile = makeTile(receivers, 0, receivers.points.size());
  ASSERT_EQ(tile.strips.size(), 1u);
  const auto visible = [&](PairMasks* pairs) {
    pairs->reset(20, tile.strips.size());
    std::fill(pairs->bits.begin(), pairs->bits.end(), uint16_t{0xffff});
    return keepVisible(tile, block, tracer_, pairs);
  };
  PairMasks one, many;
  const size_t rays = visible(&one);
  EXPECT_GT(rays, 20u);
  constexpr size_t kStrips = 40;
  tile.strips.assign(kStrips, PointStrip(tile.strips[0]));
  EXPECT_EQ(visible(&many), kStrips * rays);
  for (size_t l = 0; l < 20; ++l)
    for (size_t s = 0; s < kStrips; ++s) EXPECT_EQ(many.at(l, s), one.at(l, 0)) << l << ' ' << s;
}

}  // namespace
}  // namespace lobelia
