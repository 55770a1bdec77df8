#include <gtest/gtest.h>

#include "lobelia/lights/light_pass.h"
#include "support/box_scene.h"

namespace lobelia {
namespace {

constexpr int kWidth = 256, kHeight = 128;

// Dim sky with a small sun at pixel (40, 20) and a wide coloured glow.
Scene skyScene(const Mat4& toWorld = {}) {
  Scene scene = test::boxScene(false);
  Image image;
  image.width = kWidth;
  image.height = kHeight;
  image.channels = 3;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool sun = std::abs(x - 40) <= 1 && std::abs(y - 20) <= 1;
      const float glow =
          std::exp(-0.002f * static_cast<float>((x - 180) * (x - 180) + (y - 70) * (y - 70)));
      const Rgb c =
          Rgb(0.2f, 0.3f, 0.5f) + Rgb(2, 1, 0.3f) * glow + (sun ? Rgb(900, 800, 600) : Rgb(0.f));
      image.pixels.insert(image.pixels.end(), {c.x, c.y, c.z});
    }
  scene.images.push_back(std::move(image));
  Emitter e;
  e.type = EmitterType::environment;
  e.image = {0};
  e.toWorld = Transform(toWorld);
  scene.emitters.push_back(e);
  return scene;
}

Scene constantScene() {
  Scene scene = test::boxScene(false);
  Emitter e;
  e.type = EmitterType::constant;
  e.radiance = Rgb(1, 2, 3);
  scene.emitters.push_back(e);
  return scene;
}

// Integral of radiance over the sphere by the image's own pixels.
Rgb imageEnergy(const Scene& scene) {
  const Image& image = scene.images[0];
  Vec3d sum;
  for (int y = 0; y < kHeight; ++y) {
    const double solid =
        2.0 * kPi / kWidth *
        (std::cos(y * 1.0 * kPi / kHeight) - std::cos((y + 1) * 1.0 * kPi / kHeight));
    for (int x = 0; x < kWidth; ++x)
      sum += Vec3d(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)) * solid;
  }
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

Rgb total(const std::vector<DirectionalLight>& lights) {
  Rgb sum;
  for (const DirectionalLight& l : lights) sum += l.irradiance;
  return sum;
}

// Irradiance on a plane.
Rgb onPlane(const std::vector<DirectionalLight>& lights, Vec3f n) {
  Rgb sum;
  for (const DirectionalLight& l : lights) sum += l.irradiance * std::max(0.f, dot(n, l.direction));
  return sum;
}

TEST(EnvironmentLights, KeepTheEnergyForAnyCount) {
  const Scene scene = skyScene();
  const Rgb expected = imageEnergy(scene);
  Rgb first;
  for (const size_t count : {1u, 7u, 64u, 300u, 5000u}) {
    const auto lights = environmentLights(scene, count, 1);
    EXPECT_EQ(lights.size(), count);
    const Rgb sum = total(lights);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 0.01f * expected[c]);
    if (count == 1) first = sum;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], first[c], 2e-3f * first[c]);
  }
}

TEST(EnvironmentLights, ConstantsAreEvenlySpread) {
  const auto lights = environmentLights(constantScene(), 256, 1);
  ASSERT_EQ(lights.size(), 256u);
  const Rgb sum = total(lights);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(sum[c], 4 * kPi * static_cast<float>(c + 1), 1e-3f * sum[c]);
  for (const DirectionalLight& l : lights) {
    EXPECT_NEAR(length(l.direction), 1, 1e-5);
    EXPECT_LT(l.irradiance.x, 4 * sum.x / 256);
    EXPECT_GT(l.irradiance.x, sum.x / 256 / 4);
  }
  for (const Vec3f n : {Vec3f(0, 1, 0), Vec3f(1, 0, 0), Vec3f(0.6f, 0, -0.8f)})
    EXPECT_NEAR(onPlane(lights, n).x, kPi, 0.05f * kPi);
}

// The strata do what strata are for: a plane's irradiance is right with few lights, wherever the
// sky is turned.
TEST(EnvironmentLights, RotationsAndPlanes) {
  for (const Mat4& turn : {Mat4{}, rotation({0, 1, 0}, 77), rotation({1, 2, 3}, 130)}) {
    const Scene scene = skyScene(turn);
    const EmitterSampler emitters(scene, bounds(scene));
    const auto lights = environmentLights(emitters, 400, 5);
    for (const Vec3f n : {Vec3f(0, 1, 0), Vec3f(0, -1, 0), Vec3f(1, 0, 0), Vec3f(0, 0, 1)}) {
      Vec3d sum;  // quadrature over a fine grid that knows nothing of the map's frame
      const int w = 1024, h = 512;
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
          const double c = 1 - 2 * (y + 0.5) / h, phi = 2.0 * kPi * (x + 0.5) / w;
          const double s = std::sqrt(1 - c * c);
          const Vec3f d(static_cast<float>(s * std::cos(phi)), static_cast<float>(c),
                        static_cast<float>(s * std::sin(phi)));
          const Rgb l = emitters.escaped(d) * std::max(0.f, dot(n, d));
          sum += Vec3d(l.x, l.y, l.z) * (4.0 * kPi / (w * h));
        }
      EXPECT_NEAR(onPlane(lights, n).y, sum.y, 0.06 * sum.y + 0.02);
    }
    // The sun is where the environment says it is.
    const auto sun = std::max_element(lights.begin(), lights.end(), [](auto& a, auto& b) {
      return a.irradiance.x < b.irradiance.x;
    });
    EXPECT_GT(emitters.escaped(sun->direction).x, 100);
  }
}

TEST(EnvironmentLights, SeedsTurnTheDirectionsOnly) {
  const Scene scene = skyScene();
  const auto a = environmentLights(scene, 50, 1), b = environmentLights(scene, 50, 1),
             c = environmentLights(scene, 50, 2);
  ASSERT_EQ(a.size(), c.size());
  size_t moved = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].direction, b[i].direction);
    EXPECT_EQ(a[i].irradiance, c[i].irradiance);
    moved += a[i].direction != c[i].direction;
  }
  EXPECT_GT(moved, 40u);
}

TEST(EnvironmentLights, NoneWhereThereIsNoEnvironment) {
  EXPECT_TRUE(environmentLights(test::boxScene(), 100, 1).empty());
  EXPECT_TRUE(environmentLights(constantScene(), 0, 1).empty());
}

}  // namespace
}  // namespace lobelia
