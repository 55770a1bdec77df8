// Cameras: where rays go, and that light tracing's importance measures what rays measure.
#include "lobelia/scene/camera.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

Camera makeCamera(CameraType type) {
  Camera c;
  c.type = type;
  c.width = 40, c.height = 20;
  c.fovX = 0.9f;
  c.toWorld = Transform(*lookAt({1, 2, 3}, {2, 2.5, 7}, {0, 1, 0}));
  c.nearClip = 0.1f, c.farClip = 100;
  return c;
}

TEST(Camera, FirstPixelIsTopLeft) {
  Camera c = makeCamera(CameraType::perspective);
  c.toWorld = Transform(*lookAt({0, 0, 0}, {0, 0, 1}, {0, 1, 0}));
  const Ray r = generateRay(c, {0, 0}, {});
  // Looking along +z with y up, x points to the left of the picture.
  EXPECT_NEAR(r.d.x / r.d.z, std::tan(0.45f), 1e-5f);
  EXPECT_NEAR(r.d.y / r.d.z, std::tan(0.45f) / 2, 1e-5f);
  EXPECT_NEAR(length(r.d), 1, 1e-6f);
  EXPECT_NEAR(r.tMin * r.d.z, 0.1f, 1e-6f);
  EXPECT_NEAR(r.tMax * r.d.z, 100, 1e-3f);
  const Ray centre = generateRay(c, {20, 10}, {});
  EXPECT_NEAR(centre.d.z, 1, 1e-6f);
}

TEST(Camera, PrincipalPointOffsetMovesTheFilm) {
  Camera c = makeCamera(CameraType::perspective);
  const Ray expected = generateRay(c, {24, 7}, {});
  c.principalPointOffset = {0.1f, -0.15f};
  const Ray r = generateRay(c, {20, 10}, {});
  EXPECT_NEAR(length(r.d - expected.d), 0, 1e-6f);
}

TEST(Camera, OrthographicSpansMinusOneToOne) {
  Camera c = makeCamera(CameraType::orthographic);
  c.toWorld = Transform(translation({0, 0, -5}) * scaling({3, 3, 1}));
  const Ray r = generateRay(c, {0, 0}, {});
  EXPECT_NEAR(length(r.o - Vec3f(3, 1.5f, -4.9f)), 0, 1e-6f);
  EXPECT_EQ(r.d, Vec3f(0, 0, 1));
  EXPECT_FLOAT_EQ(r.tMax, 99.9f);
}

TEST(Camera, LensRaysMeetInThePlaneInFocus) {
  Camera c = makeCamera(CameraType::perspective);
  const Ray pinhole = generateRay(c, {11, 4}, {});
  c.apertureRadius = 0.3f, c.focusDistance = 4;
  const Vec3f axis = c.toWorld.vector({0, 0, 1});
  const Vec3f focus = pinhole.o + pinhole.d * (4 / dot(pinhole.d, axis));
  Rng rng(1);
  float spread = 0;
  for (int i = 0; i < 50; ++i) {
    const Ray r = generateRay(c, {11, 4}, rng.next2D());
    EXPECT_NEAR(length(r.o + r.d * (4 / dot(r.d, axis)) - focus), 0, 1e-5f);
    spread = std::max(spread, length(r.o - pinhole.o));
    EXPECT_LE(length(r.o - pinhole.o), 0.3f + 1e-6f);
  }
  EXPECT_GT(spread, 0.2f);
}

class Connection : public testing::TestWithParam<int> {};

// 0: pinhole with offset, 1: lens, 2: orthographic, scaled.
Camera connectedCamera(int kind) {
  Camera c = makeCamera(kind == 2 ? CameraType::orthographic : CameraType::perspective);
  c.principalPointOffset = {0.05f, -0.1f};
  if (kind == 1) c.apertureRadius = 0.2f, c.focusDistance = 3;
  if (kind == 2) c.toWorld = Transform(c.toWorld.to * scaling({2, 2, 1}));
  return c;
}

TEST_P(Connection, InvertsRays) {
  const Camera c = connectedCamera(GetParam());
  Rng rng(2);
  for (int i = 0; i < 500; ++i) {
    const Vec2f film{rng.next1D() * 40, rng.next1D() * 20}, lens = rng.next2D();
    const Ray r = generateRay(c, film, lens);
    const float t = r.tMin + (std::min(r.tMax, 50.f) - r.tMin) * rng.next1D();
    FilmConnection connection;
    ASSERT_TRUE(connectToCamera(c, r.o + r.d * t, lens, &connection));
    EXPECT_NEAR(connection.film.x, film.x, 0.02f);
    EXPECT_NEAR(connection.film.y, film.y, 0.02f);
    if (GetParam() != 2) {
      EXPECT_NEAR(length(connection.lens - r.o), 0, 1e-5f);
    }
  }
}

// A plane patch of radiance 1 across the view: every pixel that it covers has value 1, whether seen
// by rays or by points sampled on the patch and connected.
TEST_P(Connection, ImportanceMeasuresWhatRaysMeasure) {
  const Camera c = connectedCamera(GetParam());
  // A tilted rectangle in front of the camera that covers the film's middle.
  const float size = GetParam() == 2 ? 2.f : 6.f;
  const Vec3f corner = c.toWorld.point({-size, -size, 4});
  const Vec3f u = c.toWorld.vector({2 * size, 0, size / 2});
  const Vec3f v = c.toWorld.vector({0, 2 * size, size / 6});
  const Vec3f n = normalize(cross(u, v));
  const float area = length(cross(u, v));
  Rng rng(5);
  constexpr int kCount = 400000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kCount; ++i) {
    const Vec3f p = corner + u * rng.next1D() + v * rng.next1D();
    FilmConnection f;
    double value = 0;
    if (connectToCamera(c, p, rng.next2D(), &f) && f.film.x >= 10 && f.film.x < 30 &&
        f.film.y >= 5 && f.film.y < 15) {
      const Vec3f axis = normalize(c.toWorld.vector({0, 0, 1}));
      const Vec3f d = GetParam() == 2 ? axis : normalize(p - f.lens);
      value = double{f.importance} * std::abs(dot(n, d)) * area / 200;  // mean over 200 pixels
    }
    sum += value, squares += value * value;
  }
  const double mean = sum / kCount;
  const double sigma = std::sqrt((squares / kCount - mean * mean) / kCount);
  EXPECT_NEAR(mean, 1, 4 * sigma);
  EXPECT_LT(sigma, 0.01);
}

TEST_P(Connection, FailsOutsideFilmAndClipRange) {
  const Camera c = connectedCamera(GetParam());
  FilmConnection f;
  EXPECT_FALSE(connectToCamera(c, c.toWorld.point({0, 0, -1}), {}, &f));
  EXPECT_FALSE(connectToCamera(c, c.toWorld.point({0, 0, 0.05f}), {}, &f));
  EXPECT_FALSE(connectToCamera(c, c.toWorld.point({0, 0, 101}), {}, &f));
  EXPECT_FALSE(connectToCamera(c, c.toWorld.point({50, 0, 5}), {}, &f));
  EXPECT_TRUE(connectToCamera(c, c.toWorld.point({0, 0, 5}), {}, &f));
}

INSTANTIATE_TEST_SUITE_P(Kinds, Connection, testing::Values(0, 1, 2));

}  // namespace
}  // namespace lobelia
