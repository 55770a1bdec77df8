// A person's camera moves, and lights that are dragged in the picture.
#include "lobelia/app/viewer/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/command_line.h"
#include "lobelia/app/view_script.h"
#include "lobelia/app/viewer/light_handle.h"
#include "lobelia/base/random.h"

namespace lobelia::test {
namespace {

using app::CameraControl;

Bounds3f box(Vec3f lo, Vec3f hi) {
  Bounds3f out;
  out.add(lo);
  out.add(hi);
  return out;
}
const Bounds3f kScene = box({-1, 0, -1}, {1, 2, 1});

Camera lookingAt(Vec3d from, Vec3d to, Vec3d up = {0, 1, 0}) {
  Camera camera;
  camera.toWorld = Transform(*lookAt(from, to, up));
  camera.width = 400, camera.height = 300;
  camera.fovX = 0.8f;
  return camera;
}
Vec3f place(const Camera& c) { return c.toWorld.point({0, 0, 0}); }
Vec3f direction(const Camera& c) { return normalize(c.toWorld.vector({0, 0, 1})); }
Vec3f upward(const Camera& c) { return normalize(c.toWorld.vector({0, 1, 0})); }
void expectNear(Vec3f a, Vec3f b, float tolerance) {
  EXPECT_LT(length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

TEST(CameraControl, UntouchedItIsTheScenesToTheBit) {
  const Camera camera = lookingAt({3, 2, 4}, {0, 1, 0}, {0.2, 1, 0});
  CameraControl control(camera, kScene);
  EXPECT_EQ(control.camera().toWorld.to, camera.toWorld.to);
  control.orbit(0, 0);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(control.camera().toWorld.to.m[i][j], camera.toWorld.to.m[i][j], 1e-6);
}

TEST(CameraControl, OrbitKeepsThePivotInSightAndAtItsDistance) {
  CameraControl control(lookingAt({0, 1, 5}, {0, 1, 0}), kScene);
  control.setPivot({0, 1, 0});
  for (int i = 0; i < 40; ++i) {
    control.orbit(0.3, i % 3 == 0 ? -0.2 : 0.15);
    const Camera& c = control.camera();
    EXPECT_NEAR(length(place(c) - Vec3f(0, 1, 0)), 5, 1e-4);
    expectNear(place(c) + direction(c) * 5, {0, 1, 0}, 1e-4f);
    EXPECT_GE(upward(c).y, -1e-6f) << "it stays upright";
  }
}

TEST(CameraControl, OrbitTurnsToTheHandsSide) {
  CameraControl control(lookingAt({0, 1, 5}, {0, 1, 0}), kScene);
  control.setPivot({0, 1, 0});
  // What stands on the left of the picture (x < 0 seen from +z) ...
  const Vec3f left(-0.5f, 1, 0);
  const float before = app::project(control.camera(), left)->x;
  EXPECT_LT(before, 200);
  control.orbit(0.2, 0);  // looking further to the right
  EXPECT_GT(direction(control.camera()).x, 0.1f);
}

TEST(CameraControl, NothingTurnsItUpsideDown) {
  for (const Vec3d up : {Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1, 0, 0)}) {
    CameraControl control(lookingAt({3, 4, 5}, {0, 0.5, 0}, up), kScene);
    for (int i = 0; i < 20; ++i) control.orbit(0.1, 1.0);
    for (int i = 0; i < 20; ++i) control.look(0.1, -1.0);
    const Mat4& m = control.camera().toWorld.to;
    EXPECT_TRUE(m.isFinite());
    EXPECT_NEAR(m.determinant3(), 1, 1e-6);
    const Vec3f axis(static_cast<float>(up.x), static_cast<float>(up.y), static_cast<float>(up.z));
    EXPECT_GT(dot(upward(control.camera()), axis), 0);
  }
}

TEST(CameraControl, APannedPointFollowsTheHand) {
  CameraControl control(lookingAt({3, 2, 4}, {0, 1, 0}), kScene);
  control.setPivot({0, 1, 0});
  const Vec2f before = *app::project(control.camera(), {0, 1, 0});
  control.pan(0.1, -0.05);
  const Vec2f after = *app::project(control.camera(), {0, 1, 0});
  EXPECT_NEAR(after.x - before.x, 0.1 * 400, 0.01);
  EXPECT_NEAR(after.y - before.y, -0.05 * 400, 0.01);
}

// In a window of another shape, too, of whose width a hand moves a share.
TEST(CameraControl, WidthsAreThoseOfTheFittedFilm) {
  CameraControl control(lookingAt({3, 2, 4}, {0, 1, 0}), kScene);
  control.setPivot({0, 1, 0});
  for (const Vec2i size : {Vec2i(1600, 300), Vec2i(300, 1600)}) {
    const Vec2f before = *app::project(control.fitted(size.x, size.y), {0, 1, 0});
    const double widths = control.widths(size.x, size.y);
    control.pan(0.1 * widths, -0.05 * widths);
    const Vec2f after = *app::project(control.fitted(size.x, size.y), {0, 1, 0});
    EXPECT_NEAR(after.x - before.x, 0.1 * size.x, 0.05);
    EXPECT_NEAR(after.y - before.y, -0.05 * size.x, 0.05);
  }
}

TEST(CameraControl, DollyComesNearerAndNeverThrough) {
  CameraControl control(lookingAt({0, 1, 5}, {0, 1, 0}), kScene);
  control.setPivot({0, 1, 0});
  control.dolly(0.5);
  EXPECT_NEAR(place(control.camera()).z, 2.5, 1e-5);
  for (int i = 0; i < 200; ++i) control.dolly(0.5);
  EXPECT_GT(place(control.camera()).z, 0);
  for (int i = 0; i < 200; ++i) control.dolly(2);
  EXPECT_TRUE(control.camera().toWorld.to.isFinite());
}

TEST(CameraControl, AFramedBoxIsInSight) {
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic}) {
    Camera camera = lookingAt({9, 5, 7}, {0, 0, 0});
    camera.type = type;
    CameraControl control(camera, kScene);
    const Bounds3f small = box({0.2f, 0.1f, 0.3f}, {0.4f, 0.3f, 0.5f});
    control.frame(small);
    float widest = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3f corner(i & 1 ? small.hi.x : small.lo.x, i & 2 ? small.hi.y : small.lo.y,
                         i & 4 ? small.hi.z : small.lo.z);
      const auto film = app::project(control.camera(), corner);
      ASSERT_TRUE(film);
      EXPECT_GE(film->x, 0);
      EXPECT_LE(film->x, 400);
      EXPECT_GE(film->y, 0);
      EXPECT_LE(film->y, 300);
      widest = std::max(widest, std::abs(film->y - 150));
    }
    EXPECT_GT(widest, 60) << "and fills it";
  }
}

TEST(CameraControl, AWiderWindowShowsMoreAtTheSides) {
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic}) {
    Camera camera = lookingAt({0, 1, 5}, {0, 1, 0});
    camera.type = type;
    const CameraControl control(camera, kScene);
    const Vec3f point(0.3f, 0.4f, 0);
    const Vec2f own = *app::project(camera, point);
    const Camera wide = control.fitted(1200, 300), tall = control.fitted(400, 900);
    // Wide: as high as before, so everything keeps its distance from the middle.
    EXPECT_NEAR(app::project(wide, point)->y, own.y, 1e-3);
    EXPECT_NEAR(app::project(wide, point)->x - 600, own.x - 200, 1e-3);
    // Tall: as wide as before.
    EXPECT_NEAR(app::project(tall, point)->x, own.x, 1e-3);
    EXPECT_NEAR(app::project(tall, point)->y - 450, own.y - 150, 1e-3);
  }
}

TEST(CameraControl, KeepsMirrorsAndScale) {
  Camera camera = lookingAt({0, 1, 5}, {0, 1, 0});
  camera.toWorld = Transform(camera.toWorld.to * scaling({-2, 2, 2}));
  CameraControl control(camera, kScene);
  control.orbit(0.4, 0.1);
  control.fly({1, 2, 3});
  EXPECT_NEAR(control.camera().toWorld.to.determinant3(), -8, 1e-6);
}

TEST(CameraControl, RandomMovesStayFinite) {
  CameraControl control(lookingAt({0, 1, 5}, {0, 1, 0}), kScene);
  Rng random(7);
  for (int i = 0; i < 5000; ++i) {
    const double a = static_cast<double>(random.next1D()) * 2 - 1,
                 b = static_cast<double>(random.next1D()) * 2 - 1;
    switch (i % 7) {
      case 0:
        control.orbit(a * 3, b * 3);
        break;
      case 1:
        control.look(a * 3, b * 3);
        break;
      case 2:
        control.pan(a, b);
        break;
      case 3:
        control.dolly(std::exp(a * 3));
        break;
      case 4:
        control.fly({a, b, a});
        break;
      case 5:
        control.setFieldOfView(a * 4);
        break;
      default:
        control.frame(box({0, 0, 0}, Vec3f(static_cast<float>(std::abs(b)))));
        break;
    }
    ASSERT_TRUE(control.camera().toWorld.to.isFinite());
    ASSERT_TRUE(control.camera().toWorld.from.isFinite());
    ASSERT_GT(control.camera().fovX, 0);
  }
}

TEST(CameraControl, ItsScriptLineGivesTheSameView) {
  CameraControl control(lookingAt({3, 2, 4}, {0, 1, 0}), kScene);
  control.orbit(0.3, 0.2);
  const std::string file = testing::TempDir() + "/camera_line.script";
  writeText(file, app::cameraLine(control.camera()) + "\nframe\n");
  const std::vector<app::ScriptStep> script = app::readScript(file);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(script.front().toWorld.to.m[i][j], control.camera().toWorld.to.m[i][j], 1e-5);
}

TEST(LightHandle, AProjectedPointIsWhereItsRayGoes) {
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic}) {
    Camera camera = lookingAt({3, 2, 4}, {0, 1, 0});
    camera.type = type;
    camera.principalPointOffset = {0.1f, -0.05f};
    for (const Vec2f film : {Vec2f(10, 20), Vec2f(200, 150), Vec2f(390, 280)}) {
      const Ray ray = generateRay(camera, film, {0.5f, 0.5f});
      const auto back = app::project(camera, ray.o + ray.d * 3.f);
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x, film.x, 0.01);
      EXPECT_NEAR(back->y, film.y, 0.01);
    }
  }
}

TEST(LightHandle, WhatIsBehindHasNoPlace) {
  EXPECT_FALSE(app::project(lookingAt({0, 0, 5}, {0, 0, 0}), {0, 0, 6}));
}

TEST(LightHandle, ADraggedLightFollowsTheHandAndKeepsItsDepth) {
  for (const CameraType type : {CameraType::perspective, CameraType::orthographic}) {
    Camera camera = lookingAt({3, 2, 4}, {0, 1, 0});
    camera.type = type;
    const Vec3f light(0.3f, 1.2f, 0.1f);
    const Vec2f before = *app::project(camera, light);
    const Vec3f moved = app::movedAcross(camera, light, {30, -12});
    const Vec2f after = *app::project(camera, moved);
    EXPECT_NEAR(after.x - before.x, 30, 0.01);
    EXPECT_NEAR(after.y - before.y, -12, 0.01);
    EXPECT_NEAR(dot(moved - light, direction(camera)), 0, 1e-5);
    const Vec3f nearer = app::movedAlong(camera, light, -0.5f);
    const Vec2f still = *app::project(camera, nearer);
    EXPECT_NEAR(still.x, before.x, 0.02);
    EXPECT_NEAR(still.y, before.y, 0.02);
    EXPECT_LT(dot(nearer - light, direction(camera)), -0.1f);
  }
}

}  // namespace
}  // namespace lobelia::test
