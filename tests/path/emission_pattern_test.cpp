#include "lobelia/path/emission_pattern.h"

#include <gtest/gtest.h>

namespace lobelia {
namespace {

Rgb towards(const Scene& scene, Vec3f world) {
  const EmissionPattern pattern(scene, scene.emitters[0]);
  return pattern.at(pattern.toLocal(world));
}

TEST(EmissionPattern, SpotFallsLinearlyInAngle) {
  Scene scene;
  Emitter spot;
  spot.type = EmitterType::spot;
  spot.cutoff = 0.6f;
  spot.beamWidth = 0.2f;
  scene.emitters = {spot};
  const auto at = [&](float angle) {
    return towards(scene, Vec3f(std::sin(angle), 0, std::cos(angle)) * 3.f).x;
  };
  EXPECT_FLOAT_EQ(at(0.1f), 1.f);
  EXPECT_NEAR(at(0.4f), 0.5f, 1e-5f);
  EXPECT_NEAR(at(0.5f), 0.25f, 1e-5f);
  EXPECT_EQ(at(0.7f), 0.f);
}

TEST(EmissionPattern, ProjectorLightsAnUprightPlaneEvenly) {
  // Irradiance on the plane at distance one: intensity cos / d^2 = picture cos^-3 cos^3.
  Scene scene;
  Emitter projector;
  projector.type = EmitterType::projector;
  projector.radiance = Rgb(0.3f, 0.6f, 0.9f);
  projector.fov = 1.5f;
  scene.emitters = {projector};
  for (const float x : {-0.8f, 0.f, 0.5f}) {
    const float cosine = 1 / std::sqrt(1 + x * x);
    const Rgb value = towards(scene, Vec3f(x, 0, 1) * 2.f);
    EXPECT_NEAR(value.y * cosine * cosine * cosine, 0.6f, 1e-5f);
  }
  EXPECT_EQ(towards(scene, {1.1f, 0, 1}), Rgb(0.f));
  EXPECT_EQ(towards(scene, {0, 0, -1}), Rgb(0.f));
}

// Rows from +z (first) to -z (last), columns by azimuth from +x towards +y, centres at half
// columns.
TEST(EmissionPattern, GoniometricImageLiesAsDocumented) {
  Scene scene;
  Image image;
  image.width = 8, image.height = 5, image.channels = 1;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 8; ++x) image.pixels.push_back(static_cast<float>(10 * y + x));
  scene.images = {image};
  Emitter e;
  e.type = EmitterType::goniometric;
  e.image = {0};
  e.radiance = Rgb(2, 4, 6);
  e.scale = 0.5f;
  scene.emitters = {e};
  EXPECT_EQ(EmissionPattern(scene, scene.emitters[0]).base(), Rgb(1, 2, 3));
  for (int y = 1; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      const float theta = kPi * static_cast<float>(y) / 4;
      const float phi = kTwoPi * (static_cast<float>(x) + 0.5f) / 8;
      const Vec3f d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta)};
      EXPECT_NEAR(towards(scene, d * 7.f).x, static_cast<float>(10 * y + x), 1e-3f);
    }
  }
  EXPECT_NEAR(towards(scene, {1e-6f, 0, 1}).x, 3.5f, 4.f);    // somewhere in the first row
  EXPECT_NEAR(towards(scene, {1e-6f, 0, -1}).x, 43.5f, 4.f);  // and in the last
  // The transform turns the pattern: local +z is world +x.
  scene.emitters[0].toWorld = Transform(rotation({0, 1, 0}, 90));
  EXPECT_LT(towards(scene, {1, 0, 0}).x, 8);
  EXPECT_GE(towards(scene, {-1, 0, 0}).x, 40);
}

// Of a transform that is not rigid, the view axis, the turn about it and the flip are left.
TEST(EmissionPattern, OnlyTheRigidPartOfTheTransformCounts) {
  Scene scene;
  Emitter projector;
  projector.type = EmitterType::projector;
  projector.fov = 1.5f;
  scene.emitters = {projector};
  const auto local = [&](const Mat4& toWorld, Vec3f world) {
    scene.emitters[0].toWorld = Transform(toWorld);
    const EmissionPattern pattern(scene, scene.emitters[0]);
    EXPECT_NEAR(length(pattern.toWorld(pattern.toLocal(world)) - normalize(world)), 0, 1e-6f);
    return pattern.toLocal(world);
  };
  const auto expectNear = [](Vec3f a, Vec3f b) { EXPECT_NEAR(length(a - b), 0, 1e-6f); };
  const Vec3f d{0.3f, -0.4f, 0.5f};
  const Mat4 turn = rotation({1, 2, 3}, 50);
  const Vec3f turned = inverse(turn)->vector(d);
  expectNear(local(turn, d), turned);
  expectNear(local(turn * scaling({4, 4, 4}), d), turned);
  expectNear(local(turn * scaling({1, 2, 3e20}), d), turned);
  expectNear(local(turn * scaling({-1, 2, 3}), d), turned * Vec3f(-1, 1, 1));
  expectNear(local(turn * scaling({5, -2, 3}), d), turned * Vec3f(1, -1, 1));
  expectNear(local(turn * scaling({1, 2, -3}), d), turned * Vec3f(1, 1, -1));
  const Mat4 sheared{{{{1, 7, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}};
  expectNear(local(turn * sheared, d), turned);
  const Mat4 leaning{{{{1, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}};
  expectNear(local(leaning, {1, 0, 1}), {0, 0, std::sqrt(2.f)});
}

TEST(EmissionPattern, ScaleOfTheTransformDoesNotMatter) {
  Scene scene;
  Emitter spot;
  spot.type = EmitterType::spot;
  scene.emitters = {spot};
  for (const double scale : {1e-30, 1e-10, 1e10, 1e30}) {
    scene.emitters[0].toWorld = Transform(scaling(Vec3d(scale)));
    EXPECT_FLOAT_EQ(towards(scene, {0, 0.05f, 1}).x, 1.f) << scale;
    EXPECT_EQ(towards(scene, {0, 1, 0}).x, 0.f) << scale;
    const EmissionPattern pattern(scene, scene.emitters[0]);
    EXPECT_NEAR(length(pattern.toWorld({1, 2, 3})), 1, 1e-5f) << scale;
  }
}

}  // namespace
}  // namespace lobelia
