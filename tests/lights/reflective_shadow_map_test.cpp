#include "lobelia/lights/reflective_shadow_map.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "lights/light_source.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "support/test_scenes.h"

namespace lobelia {
namespace {

using test::addMaterial;
using test::addQuad;
using test::boxScene;
using test::Lighting;
using test::LightSource;

Material glossyMetal(float alpha) {
  Material metal;
  metal.type = MaterialType::roughConductor;
  metal.distribution = Distribution::ggx;
  metal.alphaU = alpha, metal.alphaV = alpha;
  metal.specular = Rgb(0.8f);
  return metal;
}

// A stage with a metal back wall, and things in the light that let it through: by diffuse and by
// glossy lobes, and without any rough surface.
Scene richScene(Lighting lighting) {
  Scene scene = test::stageScene();
  scene.instances[1].material = addMaterial(scene, glossyMetal(0.3f));
  Material leaf, frosted, glass;
  leaf.type = MaterialType::diffuseTransmitter;
  leaf.diffuse = Rgb(0.3f), leaf.transmittance = Rgb(0.5f, 0.4f, 0.2f);
  frosted.type = MaterialType::roughDielectric;
  frosted.alphaU = 0.3f, frosted.alphaV = 0.3f;
  glass.type = MaterialType::dielectric;
  addQuad(scene, {-1.5f, 0.2f, -0.5f}, {0, 0, 1.2f}, {1, 0, 0}, addMaterial(scene, leaf));
  addQuad(scene, {0.1f, 0.3f, -0.5f}, {0, 0, 1.2f}, {0.8f, 0, 0}, addMaterial(scene, frosted));
  addQuad(scene, {1, 0.3f, -0.5f}, {0, 0, 1.2f}, {0.8f, 0.2f, 0}, addMaterial(scene, glass));
  test::addLighting(scene, lighting);
  return scene;
}

// Power by depth and part.
using Powers = std::map<int, Vec3d>;
void add(const LightPoint& p, Powers* powers) {
  (*powers)[2 * p.depth] += {double{p.diffuse.x}, double{p.diffuse.y}, double{p.diffuse.z}};
  (*powers)[2 * p.depth + 1] += {double{p.glossy.x}, double{p.glossy.y}, double{p.glossy.z}};
}
Powers powersOf(const std::vector<LightPoint>& points) {
  Powers powers;
  for (const LightPoint& p : points) add(p, &powers);
  return powers;
}
Powers powersOf(const ShadowMaps& maps) {
  Powers powers = powersOf(maps.others);
  for (const ReflectiveShadowMap& map : maps.maps)
    for (const LightPoint& p : map.texels)
      if (p.power() > 0) add(p, &powers);
  return powers;
}

struct Mean {
  double sum = 0, square = 0;
  int count = 0;
  void add(double v) { sum += v, square += v * v, ++count; }
  double mean() const { return sum / count; }
  double variance() const {  // of the mean
    return std::max(0.0, square / count - mean() * mean()) / (count - 1);
  }
};

class ShadowMapPower : public ::testing::TestWithParam<Lighting> {};
std::string nameOf(const ::testing::TestParamInfo<Lighting>& info) {
  return test::nameOf(info.param);
}
INSTANTIATE_TEST_SUITE_P(Lightings, ShadowMapPower,
                         ::testing::Values(Lighting::point, Lighting::spot, Lighting::directional,
                                           Lighting::texturedQuad, Lighting::sphere,
                                           Lighting::environment, Lighting::sun, Lighting::mixed),
                         nameOf);

// Maps and what they leave aside are, at every depth, what particles leave.
TEST_P(ShadowMapPower, IsThatOfParticles) {
  constexpr int kRuns = 16;
  std::map<int, Mean> particles, maps;
  LightSettings settings;
  settings.maxDepth = 5;
  // Many small views of what has an extent: few large ones would be noisy.
  const bool onePlace = GetParam() == Lighting::point || GetParam() == Lighting::spot ||
                        GetParam() == Lighting::directional;
  settings.count = onePlace ? 2000 : 6000;
  const ShadowMapSettings layout{onePlace ? 4096u : 16384u, onePlace ? 0u : 1024u};
  for (uint64_t seed = 0; seed < kRuns; ++seed) {
    LightSource source(richScene(GetParam()), seed);
    Powers a = powersOf(source.points(settings)), b = powersOf(source.maps(settings, layout));
    for (int key = 2; key <= 7; ++key) {
      particles[key].add(a[key].y);
      maps[key].add(b[key].y);
    }
    EXPECT_EQ(a.rbegin()->first, 7);
    EXPECT_EQ(b.rbegin()->first, 7);
    EXPECT_EQ(b.begin()->first, 2);
  }
  for (int key = 2; key <= 7; ++key) {
    const Mean &a = particles[key], &b = maps[key];
    EXPECT_GT(b.mean(), 0);
    EXPECT_NEAR(b.mean(), a.mean(), 4.5 * std::sqrt(a.variance() + b.variance()))
        << "depth " << key / 2 << (key % 2 ? ", glossy" : ", diffuse");
    EXPECT_LT(std::sqrt(a.variance() + b.variance()), (key < 4 ? 0.03 : 0.08) * a.mean())
        << "too noisy to tell";
  }
}

// A point lamp in a closed box: all of its power meets the walls, and leaves them times the albedo.
TEST(ReflectiveShadowMap, TexelsAreTheFirstSurfaces) {
  Scene scene = boxScene(false);
  Emitter point;
  point.type = EmitterType::point;
  point.radiance = Rgb(2, 3, 4);
  scene.emitters.push_back(point);
  LightSource source(scene);
  LightSettings settings;
  settings.maxDepth = 4;
  const ShadowMaps maps = source.maps(settings, {4096});
  ASSERT_EQ(maps.maps.size(), 1u);
  ASSERT_EQ(maps.maps[0].size, 64u);
  const Powers powers = powersOf(maps);
  for (int c = 0; c < 3; ++c) {
    const double albedo = double{Rgb(0.6f, 0.5f, 0.4f)[c]};
    const double power = double{Rgb(2, 3, 4)[c]} * 4 * double{kPi};
    EXPECT_NEAR(powers.at(2)[c], power * albedo, 1e-4 * power);
    EXPECT_NEAR(powers.at(4)[c], power * albedo * albedo, 0.02 * power);
  }
  double sum = 0;  // neighbours on the map are so in space
  for (size_t i = 0; i < 4096; ++i) {
    const LightPoint& p = maps.maps[0].texels[i];
    EXPECT_EQ(p.depth, 1);
    EXPECT_NEAR(maxComponent(max(p.p, -p.p)), 1, 1e-3f);
    EXPECT_LT(dot(p.n, p.p), 0) << "faces the lamp";
    if (i % 64 > 0) sum += double{length(p.p - maps.maps[0].texels[i - 1].p)};
  }
  EXPECT_LT(sum / 4032, 0.1);
  for (const LightPoint& p : maps.others) EXPECT_EQ(p.depth, 2);
  EXPECT_EQ(source.context.statistics.count("light_particles"), 4096u);
  EXPECT_EQ(source.context.statistics.count("rsm_texels"), 4096u);
  EXPECT_GT(source.context.statistics.count("path_rays"), 4096u);
}

// What leaves the other side of a surface is not the texel's.
TEST(ReflectiveShadowMap, TexelsFaceTheEmitter) {
  LightSource source(richScene(Lighting::spot));
  LightSettings settings;
  settings.maxDepth = 3;
  const ShadowMaps maps = source.maps(settings, {4096});
  const auto faces = [](const LightPoint& p) {
    return dot(p.n, Vec3f{0.3f, 2.5f, -0.5f} - p.p) > 0;
  };
  int lit = 0;
  for (const LightPoint& p : maps.maps[0].texels) {
    if (!(p.power() > 0)) continue;
    EXPECT_TRUE(faces(p));
    ++lit;
  }
  EXPECT_GT(lit, 2000);
  EXPECT_GT(maps.others.size(), 200u);
  for (const LightPoint& p : maps.others) EXPECT_FALSE(faces(p));
}

TEST(ReflectiveShadowMap, ViewsAndSizes) {
  LightSettings settings;
  settings.maxDepth = 3;
  const auto shape = [&](Lighting lighting, ShadowMapSettings wanted) {
    LightSource source(richScene(lighting));
    const ShadowMaps maps = source.maps(settings, wanted);
    return std::pair(maps.maps.size(), maps.maps[0].size);
  };
  EXPECT_EQ(shape(Lighting::spot, {1u << 14}), std::pair(size_t{1}, 128u));
  EXPECT_EQ(shape(Lighting::directional, {1u << 14}), std::pair(size_t{1}, 128u));
  EXPECT_EQ(shape(Lighting::quad, {1u << 14}), std::pair(size_t{64}, 16u));
  EXPECT_EQ(shape(Lighting::mixed, {1u << 14}), std::pair(size_t{64}, 16u));
  EXPECT_EQ(shape(Lighting::quad, {1000, 5}), std::pair(size_t{5}, 16u));
  EXPECT_EQ(shape(Lighting::spot, {1}), std::pair(size_t{1}, 1u));
}

// Light groups are those of the emitters of the views.
TEST(ReflectiveShadowMap, GroupsAndEmitters) {
  Scene scene = richScene(Lighting::mixed);
  for (size_t i = 0; i < scene.emitters.size(); ++i)
    if (scene.emitters[i].type == EmitterType::area) scene.emitters[i].group = "lamps";
  LightSource source(scene, 3);
  LightSettings settings;
  settings.maxDepth = 3;
  settings.directAsLights = true;
  settings.count = 20000;
  Vec3d byGroup[2][2], emitters[2];
  for (const LightPoint& p : source.points(settings)) {
    ASSERT_LT(p.group, 2);
    byGroup[0][p.group].x += p.depth == 1 ? double{p.power()} : 0;
    emitters[0].x += p.depth == 0 ? double{p.power()} : 0;
  }
  const ShadowMaps maps = source.maps(settings, {1u << 16, 256});
  for (const ReflectiveShadowMap& map : maps.maps) {
    int groups = 0;
    for (const LightPoint& p : map.texels) {
      if (!(p.power() > 0)) continue;
      byGroup[1][p.group].x += double{p.power()};
      groups |= 1 << p.group;
    }
    EXPECT_NE(groups, 3) << "one emitter has one group";
  }
  std::pair<int, int> last{0, 0};
  for (const LightPoint& p : maps.others) {
    byGroup[1][p.group].x += p.depth == 1 ? double{p.power()} : 0;
    emitters[1].x += p.depth == 0 ? double{p.power()} : 0;
    EXPECT_EQ(p.depth == 0 ? p.group : 1, 1);
    EXPECT_LE(last, std::pair(int{p.group}, int{p.depth}));
    last = {p.group, p.depth};
  }
  for (int g = 0; g < 2; ++g) {
    EXPECT_GT(byGroup[0][g].x, 0);
    EXPECT_NEAR(byGroup[1][g].x, byGroup[0][g].x, 0.1 * byGroup[0][g].x) << g;
  }
  EXPECT_NEAR(emitters[1].x, emitters[0].x, 0.1 * emitters[0].x);
}

TEST(ReflectiveShadowMap, DepthIsLimited) {
  LightSource source(richScene(Lighting::quad));
  LightSettings settings;
  settings.maxDepth = 3;
  for (const LightPoint& p : source.maps(settings, {4096}).others) EXPECT_EQ(p.depth, 1);
  settings.maxDepth = 2;
  ShadowMaps maps = source.maps(settings, {4096});
  EXPECT_TRUE(maps.maps.empty());
  EXPECT_TRUE(maps.others.empty());
  EXPECT_TRUE(source.points(settings).empty());
  // Of emitters themselves: the whole power of a Lambertian quad of area 1.
  settings.directAsLights = true;
  maps = source.maps(settings, {4096});
  EXPECT_TRUE(maps.maps.empty());
  ASSERT_EQ(maps.others.size(), 64u);
  for (const auto& points : {maps.others, source.points(settings)}) {
    const Powers powers = powersOf(points);
    ASSERT_EQ(powers.rbegin()->first, 1);
    EXPECT_NEAR(powers.at(0).y, 6 * double{kPi}, 1e-4 * 6 * double{kPi});
  }
}

TEST(ReflectiveShadowMap, StopsWhenCancelled) {
  LightSource source(richScene(Lighting::quad));
  source.context.cancel();
  for (const ReflectiveShadowMap& map : source.maps({}, {4096}).maps)
    for (const LightPoint& p : map.texels) EXPECT_EQ(p.power(), 0.f);
}

bool sameBytes(const std::vector<LightPoint>& a, const std::vector<LightPoint>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

TEST(ReflectiveShadowMap, TheNumberOfThreadsChangesNothing) {
  std::vector<ShadowMaps> maps;
  std::vector<std::vector<LightPoint>> points;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    LightSource source(richScene(Lighting::mixed), 9);
    maps.push_back(source.maps({}, {4096}));
    points.push_back(source.points({}));
  }
  ASSERT_EQ(maps[0].maps.size(), maps[1].maps.size());
  for (size_t i = 0; i < maps[0].maps.size(); ++i)
    EXPECT_TRUE(sameBytes(maps[0].maps[i].texels, maps[1].maps[i].texels));
  EXPECT_TRUE(sameBytes(maps[0].others, maps[1].others));
  EXPECT_TRUE(sameBytes(points[0], points[1]));
  LightSource other(richScene(Lighting::mixed), 10);
  EXPECT_FALSE(sameBytes(other.maps({}, {4096}).others, maps[0].others));
}

// Where every vertex leaves one light, points and lights are of the same particles: each point is
// the light that stands there.
TEST(LightPoints, AreTheLightsOfTheSameParticles) {
  Scene scene = boxScene();
  const MaterialHandle metal = addMaterial(scene, glossyMetal(0.2f));
  scene.instances[test::floorWall].material = metal;
  scene.instances[test::leftWall].material = metal;
  LightSource source(scene);
  const std::vector<LightPoint> points = source.points({});
  const VirtualLights lights = makeLights(source.tracer, source.emitters, {}, source.context);
  ASSERT_EQ(points.size(), lights.diffuse.size() + lights.glossy.size());
  std::map<std::tuple<float, float, float>, const LightPoint*> byPlace;
  for (const LightPoint& p : points) byPlace[{p.p.x, p.p.y, p.p.z}] = &p;
  for (const DiffuseLight& l : lights.diffuse) {
    const LightPoint* p = byPlace.at({l.p.x, l.p.y, l.p.z});
    EXPECT_EQ(p->diffuse * kInvPi, l.intensity);
    EXPECT_EQ(p->glossy, Rgb());
    EXPECT_EQ(encodeOctahedral(p->n), l.normal);
    EXPECT_EQ(p->depth, l.tag & 0xff);
  }
  ASSERT_GT(lights.glossy.size(), 100u);
  for (const GlossyLight& l : lights.glossy) {
    const LightPoint* p = byPlace.at({l.p.x, l.p.y, l.p.z});
    const Rgb intensity = p->glossy * lobes::clippedPeak(dot(p->axis, p->n), p->sharpness);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(intensity[c], l.intensity[c], 1e-6f * l.intensity[c]);
    EXPECT_EQ(p->n, l.n);
    EXPECT_EQ(p->axis, l.axis);
    EXPECT_EQ(p->sharpness, l.sharpness);
  }
}

// Both sides of surfaces that let light through, and the whole against lights of both classes.
TEST(LightPoints, PowerIsThatOfLights) {
  LightSettings settings;
  settings.count = 60000;
  settings.maxDepth = 4;
  LightSource source(richScene(Lighting::spot));
  const std::vector<LightPoint> points = source.points(settings);
  EXPECT_NEAR(static_cast<double>(points.size()), 6e4, 3e3);
  const VirtualLights lights = makeLights(source.tracer, source.emitters, settings, source.context);
  const Powers powers = powersOf(points);
  double diffuse = 0, glossy = 0;
  for (const DiffuseLight& l : lights.diffuse) diffuse += double{l.intensity.y * kPi};
  for (const GlossyLight& l : lights.glossy)
    glossy += double{l.intensity.y / lobes::clippedPeak(dot(l.axis, l.n), l.sharpness)};
  EXPECT_NEAR(powers.at(2).y + powers.at(4).y, diffuse, 0.015 * diffuse);
  EXPECT_NEAR(powers.at(3).y + powers.at(5).y, glossy, 0.03 * glossy);
  int below = 0, glossyBelow = 0;
  for (const LightPoint& p : points) {
    EXPECT_NEAR(length(p.n), 1, 1e-4f);
    below += p.depth == 1 && p.n.y < -0.99f && p.diffuse.x > 0;
    glossyBelow += p.depth == 1 && p.n.y < -0.99f && p.glossy.x > 0;
  }
  EXPECT_GT(below, 1000);
  EXPECT_GT(glossyBelow, 1000);
  for (size_t i = 1; i < points.size(); ++i) EXPECT_LE(points[i - 1].depth, points[i].depth);
}

TEST(LightPoints, EmittersAloneHaveAllThatLightsSay) {
  LightSource source(richScene(Lighting::mixed), 5);
  LightSettings settings;
  settings.directAsLights = true;
  settings.kind = LightKind::gaussian;
  settings.specularLimit = 0.2f, settings.maxDepth = 7, settings.environmentLights = 16;
  const VirtualLights alone = emitterLights(source.emitters, settings, source.context);
  EXPECT_EQ(alone.model, "vsgl");
  settings.kind = LightKind::glossy;
  const VirtualLights all = makeLights(source.tracer, source.emitters, settings, source.context);
  EXPECT_EQ(alone.maxDepth, 7);
  EXPECT_EQ(alone.specularLimit, 0.2f);
  EXPECT_TRUE(alone.direct);
  EXPECT_EQ(alone.seed, all.seed);
  EXPECT_EQ(alone.groups, all.groups);
  EXPECT_EQ(alone.size(), alone.omni.size() + alone.directional.size());
  ASSERT_EQ(alone.omni.size(), all.omni.size());
  ASSERT_EQ(alone.directional.size(), all.directional.size());
  EXPECT_EQ(alone.omniGroups, all.omniGroups);
  EXPECT_EQ(alone.directionalGroups, all.directionalGroups);
  EXPECT_GT(alone.omni.size(), 1u);
  EXPECT_GT(alone.directional.size(), 16u);
  for (size_t i = 0; i < alone.directional.size(); ++i)
    EXPECT_EQ(alone.directional[i].irradiance, all.directional[i].irradiance);
  settings.directAsLights = false;
  EXPECT_EQ(emitterLights(source.emitters, settings, source.context).size(), 0u);
}

TEST(MapOfPoints, KeepsPointsAndNeighbours) {
  Rng random(8);
  Bounds3f bounds;
  bounds.add({-5, 2, 0}), bounds.add({5, 4, 3});
  std::vector<LightPoint> points(3000);
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].p =
        bounds.lo + Vec3f(random.next1D(), random.next1D(), random.next1D()) * bounds.extent();
    points[i].diffuse = Rgb(static_cast<float>(i + 1));
  }
  const ReflectiveShadowMap map = mapOfPoints(points, bounds);
  ASSERT_EQ(map.size, 64u);
  ASSERT_EQ(map.texels.size(), 64u * 64u);
  std::vector<int> found(points.size() + 1);
  double near = 0, far = 0;
  int pairs = 0;
  for (size_t i = 0; i < map.texels.size(); ++i) {
    const LightPoint& p = map.texels[i];
    if (!(p.power() > 0)) continue;
    const size_t index = static_cast<size_t>(p.diffuse.x);
    ++found[index];
    EXPECT_EQ(p.p, points[index - 1].p);
    if (i % 64 == 0 || !(map.texels[i - 1].power() > 0)) continue;
    near += double{length(p.p - map.texels[i - 1].p)};
    far += double{length(p.p - points[i % points.size()].p)};
    ++pairs;
  }
  for (size_t i = 1; i < found.size(); ++i) EXPECT_EQ(found[i], 1);
  EXPECT_GT(pairs, 2500);
  EXPECT_LT(near, 0.25 * far);
  EXPECT_EQ(mapOfPoints({}, bounds).size, 1u);
  EXPECT_EQ(mapOfPoints({points[0]}, bounds).texels[0].diffuse, points[0].diffuse);
}

}  // namespace
}  // namespace lobelia
