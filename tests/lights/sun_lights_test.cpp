#include <gtest/gtest.h>

#include "lobelia/lights/light_pass.h"
#include "support/test_scenes.h"

namespace lobelia {
namespace {

Scene sunny(float radius) {
  Scene scene = test::stageScene();
  addLighting(scene, test::Lighting::sun);
  scene.emitters[0].angularRadius = radius;
  return scene;
}

// Irradiance on a plane, as the disc's radiance gives it: E times the cosine where all of the disc
// is above the plane (the disc's mean direction has length cos^2(r/2), its total 1 / that).
TEST(SunLights, KeepTheIrradianceOnAnyPlane) {
  for (const float radius : {0.f, 0.0046f, 0.3f}) {
    const Scene scene = sunny(radius);
    const Vec3f towards = -normalize(scene.emitters[0].direction);
    for (const Vec3f n : {towards, Vec3f(0, 1, 0)}) {
      Rgb sum{};
      constexpr int kSets = 200;
      for (uint64_t seed = 0; seed < kSets; ++seed) {
        const auto lights = sunLights(scene, 16, seed);
        EXPECT_EQ(lights.size(), radius > 0 ? 16u : 1u);
        for (const DirectionalLight& l : lights) {
          EXPECT_NEAR(length(l.direction), 1, 1e-5f);
          EXPECT_GE(dot(l.direction, towards), std::cos(radius) - 1e-5f);
          EXPECT_EQ(l.emitter, 0u);
          sum += l.irradiance * (dot(n, l.direction) / kSets);
        }
      }
      const Rgb expected = scene.emitters[0].radiance.value * dot(n, towards);
      EXPECT_NEAR(sum.x, expected.x, 0.003f * expected.x) << radius;
      EXPECT_NEAR(sum.z, expected.z, 0.003f * expected.z) << radius;
    }
  }
}

TEST(SunLights, EnvironmentLightsLeaveTheSunOut) {
  Scene scene = test::stageScene();
  addLighting(scene, test::Lighting::sunAndSky);
  Scene sky = test::stageScene();
  addLighting(sky, test::Lighting::environment);
  const auto both = environmentLights(scene, 64, 3), alone = environmentLights(sky, 64, 3);
  ASSERT_EQ(both.size(), alone.size());
  for (size_t i = 0; i < both.size(); ++i) {
    EXPECT_EQ(both[i].irradiance, alone[i].irradiance);
    EXPECT_EQ(both[i].emitter, 1u);
  }
}

}  // namespace
}  // namespace lobelia
