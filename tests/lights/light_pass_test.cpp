#include "lobelia/lights/light_pass.h"

#include <gtest/gtest.h>

#include <cstring>

#include "lights/light_source.h"
#include "lobelia/base/parallel.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "support/box_scene.h"

namespace lobelia {
namespace {

using test::addMaterial;
using test::boxScene;
using test::LightSource;

Scene pointScene() {
  Scene scene = boxScene(false);
  Emitter point;
  point.type = EmitterType::point;
  point.radiance = Rgb(2, 3, 4);
  point.toWorld = Transform(translation({0.2, 0.1, -0.3}));
  scene.emitters.push_back(point);
  return scene;
}

Scene glossyScene(float alpha) {
  Scene scene = boxScene();
  Material metal;
  metal.type = MaterialType::roughConductor;
  metal.distribution = Distribution::ggx;
  metal.alphaU = alpha;
  metal.alphaV = alpha;
  metal.specular = Rgb(0.8f);
  const MaterialHandle handle = addMaterial(scene, metal);
  scene.instances[test::floorWall].material = handle;
  scene.instances[test::leftWall].material = handle;
  return scene;
}

// Flux of the diffuse lights with depth in [from, to].
Rgb diffuseFlux(const VirtualLights& lights, uint32_t from, uint32_t to) {
  Vec3d sum;
  for (const DiffuseLight& l : lights.diffuse)
    if ((l.tag & 0xff) >= from && (l.tag & 0xff) <= to)
      sum += Vec3d(l.intensity.x, l.intensity.y, l.intensity.z) * (1.0 * kPi);
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

Rgb glossyFlux(const VirtualLights& lights) {
  Vec3d sum;
  for (const GlossyLight& l : lights.glossy) {
    const double a = lobes::hemisphereIntegral(dot(l.axis, l.n), l.sharpness);
    sum += Vec3d(l.intensity.x, l.intensity.y, l.intensity.z) * a;
  }
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

void expectNear(Rgb value, Rgb expected, float relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], relative * expected[c]);
}

// All of a point light's flux 4 pi I meets the walls and leaves them times the albedo. Every
// particle carries the same power: there is no noise at depth 1.
TEST(LightPass, FluxOfTheFirstLights) {
  LightSource source(pointScene());
  LightSettings settings;
  settings.maxDepth = 3;
  const VirtualLights lights = source.run(settings);
  const Rgb albedo(0.6f, 0.5f, 0.4f);
  expectNear(diffuseFlux(lights, 1, 1), albedo * Rgb(2, 3, 4) * (4 * kPi), 1e-3f);
  EXPECT_EQ(lights.diffuseDepthEnds.size(), 2u);
  EXPECT_NEAR(static_cast<double>(lights.size()), 4096, 4096 * 0.05);
}

// In a closed box each bounce multiplies the flux by the albedo: all depths sum to a series.
TEST(LightPass, FluxOfAllLights) {
  LightSource source(pointScene());
  LightSettings settings;
  settings.count = 200000;
  const VirtualLights lights = source.run(settings);
  for (int c = 0; c < 3; ++c) {
    const float albedo = Rgb(0.6f, 0.5f, 0.4f)[c], power = Rgb(2, 3, 4)[c] * 4 * kPi;
    EXPECT_NEAR(diffuseFlux(lights, 1, 255)[c], power * albedo / (1 - albedo), 0.01f * power);
    EXPECT_NEAR(diffuseFlux(lights, 3, 3)[c], power * albedo * albedo * albedo, 0.01f * power);
  }
}

// Particles take of a light's transform what everything else takes: the turn and the flip.
TEST(LightPass, LightsOutOfShapeShineAsRigidOnes) {
  const auto lightsOf = [](Vec3d scale) {
    Scene scene = pointScene();
    Emitter& spot = scene.emitters.back();
    spot.type = EmitterType::spot;
    spot.cutoff = 1;
    spot.toWorld = Transform(spot.toWorld.to * rotation({1, 2, 3}, 30) * scaling(scale));
    LightSource source(scene);
    LightSettings settings;
    settings.maxDepth = 3;
    settings.directAsLights = true;
    return source.run(settings);
  };
  const VirtualLights rigid = lightsOf({1, -1, 1}), bent = lightsOf({2, -1, 5});
  ASSERT_EQ(bent.omni.size(), 1u);
  EXPECT_EQ(bent.omni[0].intensity, rigid.omni[0].intensity);
  ASSERT_EQ(bent.diffuse.size(), rigid.diffuse.size());
  ASSERT_GT(rigid.diffuse.size(), 1000u);
  for (size_t i = 0; i < rigid.diffuse.size(); ++i) {
    EXPECT_NEAR(length(bent.diffuse[i].p - rigid.diffuse[i].p), 0, 1e-5f);
    EXPECT_NEAR(length(bent.diffuse[i].intensity - rigid.diffuse[i].intensity), 0,
                1e-4f * rigid.diffuse[i].intensity.x);
  }
}

// The sum of lights estimates the same thing however many are asked for, also when the pilot is a
// large part of the work.
TEST(LightPass, EnergyDoesNotDependOnTheCount) {
  const auto mean = [](size_t count, int runs) {
    Rgb sum;
    for (int i = 0; i < runs; ++i) {
      LightSource source(glossyScene(0.3f), static_cast<uint64_t>(100 + i));
      LightSettings settings;
      settings.count = count;
      const VirtualLights lights = source.run(settings);
      sum += diffuseFlux(lights, 0, 255) + glossyFlux(lights);
    }
    return sum / static_cast<float>(runs);
  };
  const Rgb many = mean(200000, 1);
  expectNear(mean(100000, 1), many, 0.01f);
  expectNear(mean(2000, 30), many, 0.015f);
  expectNear(mean(50, 400), many, 0.02f);
}

TEST(LightPass, OneGaussianStandsForAll) {
  LightSource source(glossyScene(0.2f));
  LightSettings settings;
  settings.count = 40000;
  const Rgb one = glossyFlux(source.run(settings));
  settings.everyGaussian = true;
  settings.count = 200000;
  const Rgb every = glossyFlux(source.run(settings));
  EXPECT_GT(one.x, 0.1f);
  expectNear(one, every, 0.02f);
}

TEST(LightPass, DepthsAreSortedAndLimited) {
  LightSource source(glossyScene(0.2f));
  LightSettings settings;
  settings.maxDepth = 5;
  const VirtualLights lights = source.run(settings);
  ASSERT_FALSE(lights.diffuse.empty());
  ASSERT_FALSE(lights.glossy.empty());
  ASSERT_EQ(lights.diffuseDepthEnds.size(), 4u);
  EXPECT_EQ(lights.diffuseDepthEnds[0], 0u) << "emitters are lit directly";
  EXPECT_EQ(lights.diffuseDepthEnds.back(), lights.diffuse.size());
  EXPECT_EQ(lights.glossyDepthEnds.back(), lights.glossy.size());
  for (size_t i = 0; i < lights.diffuse.size(); ++i) {
    const uint32_t depth = lights.diffuse[i].tag & 0xff;
    ASSERT_GE(depth, 1u);
    ASSERT_LE(depth, 3u);
    ASSERT_LT(i, lights.diffuseDepthEnds[depth]);
    ASSERT_GE(i, lights.diffuseDepthEnds[depth - 1]);
  }
  settings.maxDepth = 2;
  EXPECT_EQ(source.run(settings).size(), 0u);
}

// Blocks of lights, which are traced together, are small.
TEST(LightPass, NeighboursInTheArrayAreNeighbours) {
  LightSource source(glossyScene(0.2f));
  LightSettings settings;
  settings.count = 4000;
  settings.maxDepth = 5;
  const VirtualLights lights = source.run(settings);
  const auto meanDistance = [&](size_t step) {
    double sum = 0;
    for (size_t i = 0; i + step < lights.diffuse.size(); ++i)
      sum += static_cast<double>(length(lights.diffuse[i + step].p - lights.diffuse[i].p));
    return sum / static_cast<double>(lights.diffuse.size() - step);
  };
  EXPECT_LT(meanDistance(1), 0.2 * meanDistance(400));
}

TEST(LightPass, DiffuseOnly) {
  LightSource source(glossyScene(0.2f));
  LightSettings settings;
  settings.kind = LightKind::diffuse;
  const VirtualLights lights = source.run(settings);
  EXPECT_EQ(lights.model, "vpl");
  EXPECT_TRUE(lights.glossy.empty());
  EXPECT_NEAR(static_cast<double>(lights.diffuse.size()), 4096, 4096 * 0.06);
}

// Sharp lobes leave no lights but hand the power on.
TEST(LightPass, SharpSurfacesCarryNoLights) {
  LightSource source(glossyScene(0.01f));
  const VirtualLights lights = source.run({});
  EXPECT_TRUE(lights.glossy.empty());
  const Vec3f up(0, 1, 0), right(1, 0, 0);  // normals of the two metal walls
  for (const DiffuseLight& l : lights.diffuse) {
    const Vec3f n = decodeOctahedral(l.normal);
    EXPECT_TRUE(n != up && n != right);
  }
}

TEST(LightPass, EmittersAsLights) {
  Scene scene = boxScene();
  Emitter e;
  e.type = EmitterType::point;
  e.radiance = Rgb(1, 2, 3);
  e.toWorld = Transform(translation({0.5, 0, 0}));
  scene.emitters.push_back(e);
  e.type = EmitterType::spot;
  scene.emitters.push_back(e);
  e.type = EmitterType::directional;
  e.direction = {0, -2, 0};
  scene.emitters.push_back(e);
  e.type = EmitterType::constant;
  scene.emitters.push_back(e);
  LightSource source(scene);
  LightSettings settings;
  settings.maxDepth = 2;
  settings.directAsLights = true;
  settings.environmentLights = 32;
  const VirtualLights lights = source.run(settings);
  EXPECT_TRUE(lights.direct);
  EXPECT_EQ(lights.maxDepth, 2);
  EXPECT_EQ(lights.specularLimit, settings.specularLimit);
  ASSERT_EQ(lights.omni.size(), 2u);
  EXPECT_EQ(lights.omni[0].emitter, 0xffffffffu);
  EXPECT_EQ(lights.omni[0].p, Vec3f(0.5f, 0, 0));
  EXPECT_EQ(lights.omni[0].intensity, Rgb(1, 2, 3));
  EXPECT_EQ(lights.omni[1].emitter, 2u);
  ASSERT_EQ(lights.directional.size(), 1u + 32u);
  EXPECT_EQ(lights.directional[0].direction, Vec3f(0, 1, 0));
  EXPECT_EQ(lights.directional[0].irradiance, Rgb(1, 2, 3));
  // The lamp of area 1.44 and radiance (3, 4, 5), which shines down.
  ASSERT_FALSE(lights.diffuse.empty());
  ASSERT_EQ(lights.diffuseDepthEnds.size(), 1u);
  expectNear(diffuseFlux(lights, 0, 0), Rgb(3, 4, 5) * (1.44f * kPi), 0.05f);
  for (const DiffuseLight& l : lights.diffuse) EXPECT_LT(decodeOctahedral(l.normal).y, -0.9999f);
}

TEST(LightPass, TheNumberOfThreadsChangesNothing) {
  std::vector<VirtualLights> runs;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    LightSource source(glossyScene(0.2f), 9);
    runs.push_back(source.run({}));
  }
  for (size_t i = 1; i < runs.size(); ++i) {
    EXPECT_EQ(runs[i].particles, runs[0].particles);
    EXPECT_EQ(runs[i].diffuseDepthEnds, runs[0].diffuseDepthEnds);
    EXPECT_EQ(runs[i].glossyDepthEnds, runs[0].glossyDepthEnds);
    ASSERT_EQ(runs[i].diffuse.size(), runs[0].diffuse.size());
    ASSERT_EQ(runs[i].glossy.size(), runs[0].glossy.size());
    EXPECT_EQ(0, std::memcmp(runs[i].diffuse.data(), runs[0].diffuse.data(),
                             runs[0].diffuse.size() * sizeof(DiffuseLight)));
    EXPECT_EQ(0, std::memcmp(runs[i].glossy.data(), runs[0].glossy.data(),
                             runs[0].glossy.size() * sizeof(GlossyLight)));
  }
  LightSource other(glossyScene(0.2f), 10);
  EXPECT_NE(other.run({}).diffuse[0].p, runs[0].diffuse[0].p);
}

TEST(LightPass, NoEmittersNoLights) {
  LightSource source(boxScene(false));
  EXPECT_EQ(source.run({}).size(), 0u);
}

}  // namespace
}  // namespace lobelia
