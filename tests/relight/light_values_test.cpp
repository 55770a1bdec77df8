#include "lobelia/relight/light_values.h"

#include <gtest/gtest.h>

#include "lobelia/path/environment_sampling.h"
#include "relight/light_data.h"

namespace lobelia::relight {
namespace {

TEST(DirectionLookup, FindsTheNearestDirectionUpToACell) {
  for (const int levels : {0, 3, 9}) {
    const LightSamples samples = test::spiralSamples(levels);
    const DirectionLookup lookup(samples.p);
    const float cell =
        2.f / std::clamp(std::sqrt(2.f * static_cast<float>(samples.count())), 16.f, 256.f);
    Rng rng(5);
    for (int i = 0; i < 2000; ++i) {
      const Vec3f d = sampleSphereUniform(rng.next2D());
      float closest = 4;
      for (const Vec3f p : samples.p) closest = std::min(closest, length(p - d));
      EXPECT_LE(length(samples.p[lookup.nearest(d * 3.f)] - d), closest + 1.5f * cell);
    }
  }
}

// An environment whose texels are all `floor` but for one.
Scene sunnyScene(int width, int height, int x, int y, float sun, float floor) {
  Scene scene;
  Image image;
  image.width = width, image.height = height;
  image.pixels.assign(3 * static_cast<size_t>(width * height), floor);
  for (size_t c = 0; c < 3; ++c)
    image.pixels[3 * static_cast<size_t>(y * width + x) + c] = sun * static_cast<float>(c + 1);
  scene.images.push_back(std::move(image));
  Emitter emitter;
  emitter.type = EmitterType::environment;
  emitter.image = {0};
  emitter.scale = 2;
  emitter.toWorld = Transform(rotation({1, 2, 3}, 40));
  scene.emitters.push_back(emitter);
  return scene;
}

// Luminance over the sphere. The sampler's own integral is exact only where texels are small.
double integralOf(const Scene& scene) {
  const EnvironmentSampler environment(scene, scene.emitters[0]);
  if (scene.images[0].width >= 512) return environment.integral();
  constexpr int kSide = 400;
  double sum = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const Vec2f u{(static_cast<float>(x) + 0.5f) / kSide, (static_cast<float>(y) + 0.5f) / kSide};
      sum += static_cast<double>(luminance(environment.radiance(sampleSphereUniform(u))));
    }
  return sum * 4 * static_cast<double>(kPi) / (kSide * kSide);
}

double total(const LightSums& sums) { return static_cast<double>(luminance(sums.power(1))); }

// The whole of the light arrives, whatever the map and however the light is turned.
TEST(LightValues, KeepTheEnergyOfAnyMap) {
  const LightSamples samples = test::spiralSamples(11);
  const DirectionLookup lookup(samples.p);
  struct Map {
    int width, height, x, y;
    float sun, floor;
  };
  for (const Map& m : {Map{512, 256, 100, 70, 1e5f, 0.f}, Map{16, 8, 3, 3, 9.f, 0.1f},
                       Map{2048, 1024, 10, 700, 1e4f, 0.01f}}) {
    const Scene scene = sunnyScene(m.width, m.height, m.x, m.y, m.sun, m.floor);
    const double integral = integralOf(scene);
    const DistantLight light = distantLight(scene);
    for (const double degrees : {0.0, 123.0}) {
      const LightSums sums = lightSums(light, rotation({0, 1, 0}, degrees), samples, lookup);
      EXPECT_NEAR(total(sums) / integral, 1, 0.01) << m.width << " " << degrees;
    }
  }
}

TEST(LightValues, LightOfOneTexelIsWhereItShines) {
  const LightSamples samples = test::spiralSamples(11);
  const DirectionLookup lookup(samples.p);
  const Scene scene = sunnyScene(512, 256, 100, 70, 1e5f, 0.f);
  const EnvironmentSampler environment(scene, scene.emitters[0]);
  float pdf;
  const Vec3f sun = environment.sample({}, {0.5f, 0.5f}, &pdf);
  const Mat4 turned = rotation({0, 1, 0}, 35);
  const LightSums sums = lightSums(distantLight(scene), turned, samples, lookup);
  EXPECT_LT(length(sums.direction(1) - turned.vector(sun)), 0.02f);
  // Of a tree's nodes too: the sum of what lies below.
  for (size_t i = 1; i < samples.count(); ++i)
    EXPECT_NEAR(sums.power(i).y, sums.power(2 * i).y + sums.power(2 * i + 1).y, 1e-5f * (1e-6f + sums.power(i).y));
}

TEST(LightValues, ConstantLightIsEvenAndDirectionalLightIsOneDirection) {
  Scene scene;
  Emitter emitter;
  emitter.type = EmitterType::constant;
  emitter.radiance = Rgb(1, 2, 3);
  scene.emitters.push_back(emitter);
  emitter.type = EmitterType::directional;
  emitter.radiance = Rgb(7, 6, 5);
  emitter.direction = {0, -1, 0};
  scene.emitters.push_back(emitter);
  const LightSamples samples = test::spiralSamples(8);
  const LightSums sums = lightSums(distantLight(scene), {}, samples, DirectionLookup(samples.p));
  EXPECT_NEAR(sums.power(1).x, 7 + 4 * kPi, 1e-3f);
  size_t bright = 0;
  for (size_t i = samples.count(); i < 2 * samples.count(); ++i) {
    const float even = samples.measure[0];
    if (sums.power(i).x < 1.01f * even) continue;
    ++bright;
    EXPECT_NEAR(sums.power(i).x, 7 + even, 1e-3f);
    EXPECT_GT(sums.y[i], 0.99f);
  }
  EXPECT_EQ(bright, 1u);
}

}  // namespace
}  // namespace lobelia::relight
