// Which vertices surround a place.
#include "lobelia/relight/sample_mesh.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

Vec3f placeOf(const SampleMesh& mesh, const SurroundingVertices& s) {
  Vec3f p;
  for (size_t i = 0; i < 3; ++i) p += mesh.positions()[s.vertex[i]] * s.weight[i];
  return p;
}

TEST(WeldedMesh, JoinsWhatLiesInOnePlace) {
  Scene scene;
  test::place(scene, test::squareMesh());
  test::place(scene, test::squareMesh(), translation({1, 0, 0}));  // shares an edge
  test::place(scene, test::boxMesh({5, 5, 5}, {6, 6, 6}));
  scene.meshes[0].positions.emplace_back(9.f, 9.f, 9.f);  // of no triangle
  const SampleMesh mesh = weldedMesh(scene);
  EXPECT_EQ(mesh.positions().size(), 6u + 8u);
  EXPECT_EQ(mesh.triangles().size(), 4u + 12u);
}

TEST(SampleMesh, GivesPlacesBack) {
  const Scene scene = test::ballScene(3);
  const SampleMesh mesh = weldedMesh(scene);
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const uint32_t instance = rng.nextUint() % 2;
    const auto count =
        static_cast<uint32_t>(scene[scene.instances[instance].mesh].triangles.size());
    const Vec2f b = sampleTriangleUniform(rng.next2D());
    const Hit hit{0, b.x, b.y, instance, rng.nextUint() % count};
    const SurroundingVertices s = mesh.at(instance, hit.triangle, b.x, b.y);
    EXPECT_NEAR(s.weight[0] + s.weight[1] + s.weight[2], 1, 1e-6f);
    EXPECT_LT(length(placeOf(mesh, s) - surfacePoint(scene, hit).p), 1e-5f);
  }
}

// A triangle with all patterns of halved edges, and children that are halved again.
TEST(SampleMesh, FindsTheChildThatHoldsAPlace) {
  const std::vector<Vec3f> corners{{0, 0, 0}, {2, 0.3f, 0}, {0.5f, 1.5f, 1}};
  for (uint32_t outer = 1; outer < 8; ++outer)
    for (uint32_t inner = 0; inner < 8; ++inner) {
      std::vector<Vec3f> positions = corners;
      std::vector<SampleTriangle> triangles{{{0, 1, 2}, 0, 0}};
      const auto halve = [&](uint32_t t, uint32_t mask) {
        std::array<uint32_t, 6> points{};
        for (uint32_t k = 0; k < 3; ++k) {
          points[k] = triangles[t].vertex[k];
          points[3 + k] = static_cast<uint32_t>(positions.size());
          positions.push_back(
              (positions[triangles[t].vertex[k]] + positions[triangles[t].vertex[(k + 1) % 3]]) *
              0.5f);
        }
        triangles[t].firstChild = static_cast<uint32_t>(triangles.size());
        triangles[t].splitEdges = mask;
        for (const auto& c : childCorners(mask))
          triangles.push_back({{points[c[0]], points[c[1]], points[c[2]]}, 0, 0});
      };
      halve(0, outer);
      if (inner != 0) halve(1, inner);
      const SampleMesh mesh(positions, triangles, {0, 1});
      Rng rng(outer * 8 + inner);
      for (int i = 0; i < 50; ++i) {
        const Vec2f b = sampleTriangleUniform(rng.next2D());
        const SurroundingVertices s = mesh.at(0, 0, b.x, b.y);
        const Vec3f p = corners[0] * (1 - b.x - b.y) + corners[1] * b.x + corners[2] * b.y;
        EXPECT_LT(length(placeOf(mesh, s) - p), 1e-5f) << outer << " " << inner;
        for (const float w : s.weight) EXPECT_GE(w, 0);
      }
    }
}

// Children fill their parent: their areas add up and none is turned over.
TEST(SampleMesh, ChildrenFillTheirParent) {
  const Vec2f points[6] = {{0, 0}, {1, 0}, {0, 1}, {.5f, 0}, {.5f, .5f}, {0, .5f}};
  for (uint32_t mask = 1; mask < 8; ++mask) {
    float sum = 0;
    for (const auto& c : childCorners(mask)) {
      const Vec2f a = points[c[1]] - points[c[0]], b = points[c[2]] - points[c[0]];
      EXPECT_GT(a.x * b.y - a.y * b.x, 0) << mask;
      sum += a.x * b.y - a.y * b.x;
    }
    EXPECT_FLOAT_EQ(sum, 1);
  }
}

TEST(SampleMesh, RefusesWhatDoesNotFit) {
  const std::vector<Vec3f> positions(3);
  using Triangles = std::vector<SampleTriangle>;
  const auto make = [&](Triangles triangles, std::vector<uint32_t> first) {
    return SampleMesh(positions, std::move(triangles), std::move(first));
  };
  EXPECT_NO_THROW(make({{{0, 1, 2}, 0, 0}}, {0, 1}));
  EXPECT_THROW(make({{{0, 1, 3}, 0, 0}}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(make({{{0, 1, 2}, 0, 0}}, {0, 2}), std::invalid_argument);
  EXPECT_THROW(make({{{0, 1, 2}, 0, 0}}, {}), std::invalid_argument);
  EXPECT_THROW(make({{{0, 1, 2}, 0, 1}}, {0, 1}), std::invalid_argument) << "its own child";
  EXPECT_THROW(make({{{0, 1, 2}, 1, 1}}, {0, 1}), std::invalid_argument) << "children missing";
  EXPECT_THROW(make({{{0, 1, 2}, 0, 9}}, {0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace lobelia::relight
