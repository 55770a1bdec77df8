// Camera paths: what they pass, how evenly, and what they refuse.
#include "lobelia/scene/camera_path.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace lobelia {
namespace {

Camera looking(Vec3d from, Vec3d to, float fov = 0.7f) {
  Camera c;
  c.toWorld = Transform(*lookAt(from, to, {0, 1, 0}));
  c.fovX = fov;
  return c;
}

Vec3f position(const Camera& c) { return c.toWorld.point({}); }
Vec3f view(const Camera& c) { return normalize(c.toWorld.vector({0, 0, 1})); }

// Largest difference of entries.
double difference(const Mat4& a, const Mat4& b) {
  double largest = 0;
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j) largest = std::max(largest, std::abs(a.m[i][j] - b.m[i][j]));
  return largest;
}

TEST(CameraPath, KeysAreMetExactlyAndHoldAtTheEnds) {
  Camera c = looking({0, 0, 0}, {0, 0, 1});
  c.path = {{1, looking({1, 2, 3}, {4, 5, 7}).toWorld},
            {2, looking({2, 2, 3}, {4, 9, 7}).toWorld},
            {4, looking({9, 2, 3}, {4, 5, 6}).toWorld}};
  for (const CameraKey& key : c.path)
    EXPECT_EQ(cameraAt(c, static_cast<double>(key.time)).toWorld.to, key.toWorld.to);
  EXPECT_EQ(cameraAt(c, -5).toWorld.to, c.path.front().toWorld.to);
  EXPECT_EQ(cameraAt(c, 50).toWorld.to, c.path.back().toWorld.to);
}

TEST(CameraPath, BetweenKeysItMovesStraightAndTurnsEvenly) {
  Camera c;
  const Mat4 start = *lookAt({1, 2, 3}, {1, 2, 8}, {0, 1, 0});
  const Mat4 end = translation({4, 0, 2}) * translation({1, 2, 3}) * rotation({0, 1, 0}, 60) *
                   translation({-1, -2, -3}) * start;
  c.path = {{10, Transform(start)}, {12, Transform(end)}};
  for (const double t : {0.1, 0.5, 0.75}) {
    const Mat4 expected = translation({4 * t, 0, 2 * t}) * translation({1, 2, 3}) *
                          rotation({0, 1, 0}, 60 * t) * translation({-1, -2, -3}) * start;
    EXPECT_LT(difference(cameraAt(c, 10 + 2 * t).toWorld.to, expected), 1e-12);
  }
}

TEST(CameraPath, MirrorsAndScalesOfKeysAreKept) {
  Camera c;
  const Mat4 mirror = scaling({-2, 2, 2});
  c.path = {{0, Transform(translation({1, 0, 0}) * rotation({0, 1, 0}, 20) * mirror)},
            {1, Transform(translation({3, 0, 0}) * rotation({0, 1, 0}, 50) * mirror)}};
  const Mat4 expected = translation({2, 0, 0}) * rotation({0, 1, 0}, 35) * mirror;
  EXPECT_LT(difference(cameraAt(c, 0.5).toWorld.to, expected), 1e-12);
}

TEST(ViewPath, PassesItsViewsAndIsSmooth) {
  const std::array views{looking({0, 1, -5}, {0, 0, 0}, 0.5f), looking({4, 2, -1}, {0, 1, 0}, 0.9f),
                         looking({3, 3, 6}, {0, 0, 0}, 0.6f), looking({-7, 1, 2}, {0, 0, 1}, 0.7f)};
  const ViewPath path(views);
  EXPECT_EQ(path.parameter(0), 0);
  EXPECT_EQ(path.parameter(3), 1);
  for (size_t i = 0; i < views.size(); ++i) {
    const Camera c = path.at(path.parameter(i));
    EXPECT_LT(difference(c.toWorld.to, views[i].toWorld.to), 1e-9) << i;
    EXPECT_NEAR(c.fovX, views[i].fovX, 1e-6f) << i;
  }
  // No jump in place or velocity, at the views least of all: second differences shrink with h^2
  // (first differences with h), also of the direction of view.
  const auto roughness = [&](double h) {
    double worst = 0;
    for (double u = h; u + h <= 1; u += h / 2) {
      const Mat4 a = path.at(u - h).toWorld.to, b = path.at(u).toWorld.to,
                 c = path.at(u + h).toWorld.to;
      for (size_t i = 0; i < 3; ++i)
        for (size_t j : {size_t{2}, size_t{3}})
          worst = std::max(worst, std::abs(a.m[i][j] - 2 * b.m[i][j] + c.m[i][j]));
    }
    return worst;
  };
  EXPECT_LT(roughness(1e-3), 0.3 * roughness(2e-3));
  EXPECT_LT(roughness(1e-3), 1e-3);
  for (double u = 0; u <= 1; u += 0.01) {
    const Camera c = path.at(u);
    EXPECT_NEAR(c.toWorld.to.determinant3(), 1, 1e-9);
    EXPECT_GE(c.fovX, 0.5f - 1e-6f);
    EXPECT_LE(c.fovX, 0.9f + 1e-6f);
  }
}

TEST(ViewPath, TwoViewsAreJoinedByALineAtConstantSpeed) {
  const std::array views{looking({0, 0, 0}, {0, 0, 1}), looking({8, 0, 0}, {8, 0, 1})};
  const ViewPath path(views);
  for (const double u : {0.125, 0.5, 0.8}) {
    EXPECT_NEAR(position(path.at(u)).x, 8 * u, 1e-5);
    EXPECT_NEAR(view(path.at(u)).z, 1, 1e-6f);
  }
}

TEST(ViewPath, ViewsThatOnlyTurnOrRestTakeTheirTime) {
  const std::array turning{looking({0, 0, 0}, {0, 0, 1}), looking({0, 0, 0}, {1, 0, 0})};
  const Vec3f half = view(ViewPath(turning).at(0.5));
  EXPECT_NEAR(half.x, half.z, 1e-6f);
  const std::array resting{looking({0, 0, 0}, {0, 0, 1}), looking({4, 0, 0}, {4, 0, 1}),
                           looking({4, 0, 0}, {4, 0, 1}), looking({8, 0, 0}, {8, 0, 1})};
  const ViewPath path(resting);
  EXPECT_NEAR(path.parameter(1), 1. / 3, 1e-12);
  EXPECT_NEAR(path.parameter(2), 2. / 3, 1e-12);
  EXPECT_NEAR(position(path.at(0.5)).x, 4, 1e-4f);
}

TEST(ViewPath, RefusesWhatNoMotionJoins) {
  EXPECT_THROW(ViewPath({}), std::invalid_argument);
  std::array views{looking({0, 0, 0}, {0, 0, 1}), looking({1, 0, 0}, {1, 0, 1})};
  views[1].type = CameraType::orthographic;
  EXPECT_THROW(ViewPath{views}, std::invalid_argument);
  views[1] = views[0];
  views[1].toWorld = Transform(views[0].toWorld.to * scaling({-1, 1, 1}));
  EXPECT_THROW(ViewPath{views}, std::invalid_argument);
}

TEST(Turntable, KeepsItsDistanceAndItsTarget) {
  const Camera start = looking({3, 4, -5}, {1, 1, 1});
  Bounds3f scene;
  scene.add({0, 0, 0}), scene.add({2, 2, 2});
  const Vec3d pivot = turntablePivot(start, scene);
  EXPECT_NEAR(length(pivot - Vec3d(1, 1, 1)), 0, 1e-5);
  const Vec3d up = verticalAxis(start);
  EXPECT_EQ(up, Vec3d(0, 1, 0));
  EXPECT_EQ(turned(start, pivot, up, 0).toWorld.to, start.toWorld.to);
  EXPECT_EQ(turned(start, pivot, up, 1).toWorld.to, start.toWorld.to);
  const Vec3f quarter = position(turned(start, pivot, up, 0.25));
  // (x, z) around (1, 1): (2, -6) becomes (z, -x) = (-6, -2).
  EXPECT_NEAR(quarter.x, 1 - 6, 1e-4f);
  EXPECT_NEAR(quarter.y, 4, 1e-4f);
  EXPECT_NEAR(quarter.z, 1 - 2, 1e-4f);
  for (int i = 0; i < 8; ++i) {
    const Camera c = turned(start, pivot, up, i / 8.);
    const Vec3f target = normalize(Vec3f(1, 1, 1) - position(c));
    EXPECT_NEAR(length(view(c) - target), 0, 1e-5f) << i;
  }
}

TEST(Turntable, TurnsAboutTheSceneBehindTheCamera) {
  Bounds3f scene;
  scene.add({-1, -1, -1}), scene.add({1, 1, 1});
  const Vec3d pivot = turntablePivot(looking({0, 0, 5}, {0, 0, 9}), scene);
  EXPECT_NEAR(length(pivot), 0, 1e-6);
  Camera zUp = looking({0, 0, 0}, {1, 0, 0});
  zUp.toWorld = Transform(*lookAt({5, 5, 3}, {0, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(verticalAxis(zUp), Vec3d(0, 0, 1));
}

}  // namespace
}  // namespace lobelia
