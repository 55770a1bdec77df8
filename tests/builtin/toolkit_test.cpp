#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/textures.h"
#include "support/mesh_volume.h"

namespace lobelia::builtin {
namespace {

using test::volume;

// Normals and uv for every vertex, triangles with area whose side the normals agree with.
void expectSound(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const Vec3u& t : mesh.triangles) {
    const Vec3f n =
        cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    ASSERT_GT(length(n), 0);
    for (int c = 0; c < 3; ++c) ASSERT_GT(dot(n, mesh.normals[t[c]]), 0.3f * length(n));
  }
}

TEST(BuiltinToolkit, SolidsHaveTheirVolume) {
  const auto expectVolume = [](const Mesh& mesh, double expected) {
    expectSound(mesh);
    EXPECT_NEAR(volume(mesh) / expected, 1, 0.02);
  };
  expectVolume(cylinder(0.5f, 2, 0.01f, 3, 96), M_PI * 0.5);
  expectVolume(ball(0.7f, 48, 96), 4 * M_PI / 3 * 0.343);
  expectVolume(extrude(rectangle(1, 0.5f), 0.3f), 0.6);
  expectVolume(extrude(rectangle(1, 0.5f), 0.3f, 0.01f, 3), 0.6);
  // An L, which is not convex.
  expectVolume(extrude({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 1, 0.005f, 2), 3);
  expectVolume(extrude(rounded(rectangle(1, 1), 0.5f, 24), 1), 4 - (4 - M_PI) * 0.25);
  expectVolume(superellipsoid({1, 2, 3}, 1, 1, 64, 128), 4 * M_PI / 3 * 6);
  expectVolume(icosphere(4, [](Vec3f) { return 1.f; }), 4 * M_PI / 3);
  expectVolume(lathe({{0, 0}, {1, 0}, {0, 1}}, 96), M_PI / 3);
}

TEST(BuiltinToolkit, SweptTubesHaveTheVolumeOfPappus) {
  const Curve ring = smoothCurve3({{1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}}, true);
  double length = 0;
  for (int i = 0; i < 4000; ++i)
    length +=
        static_cast<double>(lobelia::length(ring(fraction(i + 1, 4000)) - ring(fraction(i, 4000))));
  SweepOptions closed;
  closed.closed = true;
  const Mesh torus = tube(ring, 0.1f, 128, 48, closed);
  expectSound(torus);
  EXPECT_NEAR(volume(torus) / (M_PI * 0.01 * length), 1, 0.02);

  const Mesh bar = tube(roundedPath({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 1e-3f), 0.01f, 64, 32);
  expectSound(bar);
  EXPECT_NEAR(volume(bar) / (M_PI * 1e-4 * 2), 1, 0.03);
  SweepOptions cone;
  cone.scale = [](float t) { return 1 - t; };
  EXPECT_NEAR(volume(tube(roundedPath({{0, 0, 0}, {0, 3, 0}}, 0), 1, 4, 64, cone)) / M_PI, 1, 0.1);
}

TEST(BuiltinToolkit, MirroringKeepsTheOutsideOut) {
  const Mesh mesh = transformed(ball(1, 16, 32), translation({1, 2, 3}) * scaling({-1, 2, 1}));
  expectSound(mesh);
  EXPECT_GT(volume(mesh), 0);
  EXPECT_LT(volume(turnedInsideOut(mesh)), 0);
  const Mesh two = merged({mesh, translated(mesh, {9, 0, 0})});
  expectSound(two);
  EXPECT_NEAR(volume(two), 2 * volume(mesh), 1e-3);
}

TEST(BuiltinToolkit, LargestPartLeavesTheRestOut) {
  const Mesh large = ball(1, 16, 32), small = ball(0.3f, 8, 16);
  const Mesh part = largestPart(merged({small, large, small}));
  expectSound(part);
  EXPECT_EQ(part.triangles.size(), large.triangles.size());
  EXPECT_DOUBLE_EQ(volume(part), volume(large));
}

// The longest image of an axis is 2.9, of the diagonal 4. Halves of one edge may be short enough by
// luck: several limits are tried.
TEST(BuiltinToolkit, RefinedEdgesAreShortInSkewedInstances) {
  for (const float longest : {0.5f, 0.56f, 0.63f, 0.71f, 0.8f, 0.9f}) {
    Scene scene;
    scene.meshes.push_back(roundedBox({1, 1, 1}, 0.1f, 2));
    Instance instance;
    instance.mesh = {0};
    instance.toWorld = Transform(scaling({4, 1, 1}) * rotation({0, 0, 1}, 45));
    scene.instances.push_back(instance);
    refine(scene, longest);
    const Mesh& mesh = scene.meshes.front();
    float most = 0;
    for (const Vec3u& t : mesh.triangles)
      for (const auto& [a, b] : {std::pair{t.x, t.y}, std::pair{t.y, t.z}, std::pair{t.z, t.x}})
        most = std::max(most, length(instance.toWorld.point(mesh.positions[a]) -
                                     instance.toWorld.point(mesh.positions[b])));
    EXPECT_LE(most, longest * 1.0001f);
    EXPECT_GT(most, longest / 4) << "no finer than it has to be";
  }
}

TEST(BuiltinToolkit, PolygonsAreTriangulatedCompletely) {
  Polygon star;
  for (int i = 0; i < 10; ++i) star.push_back(circle(i, 10) * (i % 2 ? 0.4f : 1.f));
  EXPECT_EQ(triangulate(star).size(), 8u);
}

TEST(BuiltinToolkit, NoiseRepeatsAndIsBounded) {
  double sum = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2f p{0.37f * static_cast<float>(i % 61), 0.219f * static_cast<float>(i)};
    const float v = fbm(p, {4, 7}, 4, 3);
    ASSERT_LE(std::abs(v), 1.2f);
    // Exact up to the rounding of the sum.
    ASSERT_NEAR(v, fbm(p + Vec2f(4, 7), {4, 7}, 4, 3), 1e-3f);
    sum += static_cast<double>(v);
  }
  EXPECT_NEAR(sum / 2000, 0, 0.05);
  EXPECT_NE(fbm({0.3f, 0.4f}, {4, 4}, 4, 1), fbm({0.3f, 0.4f}, {4, 4}, 4, 2));
}

// No seam: across the border neighbours differ no more than they do inside.
void expectPeriodic(const Image& image) {
  const auto difference = [&](int x0, int x1, bool rows) {
    double sum = 0;
    const int n = rows ? image.width : image.height;
    for (int i = 0; i < n; ++i)
      sum += static_cast<double>(rows ? std::abs(image.at(i, x0, 0) - image.at(i, x1, 0))
                                      : std::abs(image.at(x0, i, 0) - image.at(x1, i, 0)));
    return sum / n;
  };
  for (const bool rows : {false, true}) {
    const int n = rows ? image.height : image.width;
    double most = 0;
    for (int i = 0; i + 1 < n; ++i) most = std::max(most, difference(i, i + 1, rows));
    EXPECT_LE(difference(n - 1, 0, rows), most * 1.5 + 0.01);
  }
}

TEST(BuiltinToolkit, TexturesArePeriodicAndWithinRange) {
  constexpr int kSize = 64;
  std::map<const char*, Image> images;
  const SurfaceImages floor = wood({}, kSize), wall = tiles({}, kSize),
                      cloth = fabric(Rgb(0.5f), Rgb(0.2f), 16, kSize);
  for (const SurfaceImages& s : {floor, wall, cloth})
    for (const Image& image : {s.color, s.height, s.roughness}) {
      expectPeriodic(image);
      for (const float v : image.pixels) {
        ASSERT_GE(v, 0);
        ASSERT_LE(v, 1);
      }
    }
  expectPeriodic(marble({}, kSize));
  expectPeriodic(granite(Rgb(0.1f), Rgb(0.3f), Rgb(0.7f), 16, kSize));
  expectPeriodic(brushed(0.2f, 0.1f, kSize));
  EXPECT_EQ(marble({}, kSize).pixels, marble({}, kSize).pixels);
}

TEST(BuiltinToolkit, StripesHaveTheirShare) {
  const Image image = stripes(Rgb(1.f), Rgb(0.f), 4, 0.25f, 64);
  double sum = 0;
  for (const float v : image.pixels) sum += static_cast<double>(v);
  EXPECT_DOUBLE_EQ(sum / static_cast<double>(image.pixels.size()), 0.25);
}

}  // namespace
}  // namespace lobelia::builtin
