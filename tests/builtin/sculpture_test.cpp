#include "lobelia/builtin/sculpture.h"

#include <gtest/gtest.h>

#include <map>

#include "lobelia/base/parallel.h"
#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/pile.h"
#include "support/mesh_volume.h"

namespace lobelia {
namespace {

using test::volume;

// Edges that have no partner in the other direction.
int openEdges(const Mesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const Vec3u& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      const uint32_t a = t[c], b = t[(c + 1) % 3];
      a < b ? ++edges[{a, b}] : --edges[{b, a}];
    }
  int open = 0;
  for (const auto& [edge, balance] : edges) open += balance != 0;
  return open;
}

TEST(Sculpture, PartsHaveTheirVolume) {
  builtin::Sculpture ball;
  ball.ball({0.3f, -0.2f, 0.1f}, 0.5f, 0);
  const Mesh mesh = ball.mesh(64);
  EXPECT_NEAR(volume(mesh), 4 * M_PI / 3 * 0.125, 0.003);
  EXPECT_EQ(openEdges(mesh), 0);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f d = mesh.positions[i] - Vec3f(0.3f, -0.2f, 0.1f);
    ASSERT_NEAR(length(d), 0.5f, 0.003f);
    ASSERT_GT(dot(normalize(d), mesh.normals[i]), 0.999f);
  }
  builtin::Sculpture half = ball;
  half.standOn(-0.2f);
  EXPECT_NEAR(volume(half.mesh(64)), 2 * M_PI / 3 * 0.125, 0.003);
  builtin::Sculpture cone;  // of equal radii: a capsule
  cone.cone({0, 0, 0}, {0.6f, 0.8f, 0}, 0.25f, 0.25f, 0);
  EXPECT_NEAR(volume(cone.mesh(96)), M_PI * 0.0625 + 4 * M_PI / 3 * 0.015625, 0.003);
  builtin::Sculpture ellipsoid;
  ellipsoid.ellipsoid({}, {0.5f, 0.3f, 0.4f}, 0, {20, 40, 60});
  EXPECT_NEAR(volume(ellipsoid.mesh(96)), 4 * M_PI / 3 * 0.06, 0.003);
}

TEST(Sculpture, CarvingTakesAwayAndBlendingAdds) {
  builtin::Sculpture apart, blended, carved;
  for (builtin::Sculpture* s : {&apart, &blended, &carved}) s->ball({-0.25f, 0, 0}, 0.4f, 0);
  apart.ball({0.25f, 0, 0}, 0.4f, 0);
  blended.ball({0.25f, 0, 0}, 0.4f, 0.2f);
  carved.ball({0.25f, 0, 0}, 0.4f, 0).carved = true;
  const double ball = 4 * M_PI / 3 * 0.064, whole = volume(apart.mesh(96));
  EXPECT_GT(volume(blended.mesh(96)), whole + 0.005);
  // What is carved away is what the two have in common.
  EXPECT_NEAR(volume(carved.mesh(96)), ball - (2 * ball - whole), 0.004);
}

TEST(Sculpture, MirrorImagesAreEqual) {
  builtin::Sculpture s;
  s.ball({0, 0, 0}, 0.2f, 0);
  s.chain({{0.1f, 0, 0}, {0.5f, 0.3f, 0.1f}, {0.7f, 0, 0.2f}}, {0.1f, 0.05f}, 4, 0.05f, 8, 0.1f);
  s.sheet({0.4f, 0, 0}, {0.7f, 0.4f, 0}, {0.5f, 0.5f, 0.3f}, 0.05f, 0.02f);
  s.mirror(1, 0);
  const Mesh mesh = s.mesh(80);
  Bounds3f box;
  for (const Vec3f p : mesh.positions) box.add(p);
  EXPECT_NEAR(box.lo.x, -box.hi.x, 0.01f);
  EXPECT_EQ(openEdges(mesh), 0);
}

TEST(Sculpture, CreaturesAreClosedAndTheSameForAnyNumberOfThreads) {
  const auto dragon = [](int cells) { return builtin::dragonStatue(cells); };
  for (Mesh (*make)(int) : {+dragon, builtin::monkeyHead, builtin::hareStatue}) {
    const Mesh mesh = make(40);
    EXPECT_EQ(openEdges(mesh), 0);
    EXPECT_GT(volume(mesh), 0.05);
    const ThreadLimit one(1);
    const Mesh again = make(40);
    EXPECT_TRUE(again.positions == mesh.positions && again.triangles == mesh.triangles &&
                again.normals == mesh.normals);
  }
}

TEST(Pile, ThingsLieOnEachOther) {
  builtin::Pile pile(1, 100, [](Vec2f) { return 0.f; });
  Rng rng(7);
  constexpr float kRadius = 0.2f, kHalf = 0.02f;
  for (int i = 0; i < 5; ++i) {
    const Mat4 m = pile.settle({0, 0}, kRadius, kHalf, 0, rng);
    // Flat on flat: a stack.
    EXPECT_NEAR(m.point({}).y, kHalf * static_cast<float>(2 * i + 1), 1e-5f);
    EXPECT_NEAR(m.vector({0, 1, 0}).y, 1, 1e-6f);
    EXPECT_NEAR(m.determinant3(), 1, 1e-5);
  }
  EXPECT_NEAR(pile.heightAt({0.1f, 0}), 10 * kHalf, 1e-5f);
  EXPECT_EQ(pile.heightAt({0.5f, 0}), 0);
  // On a slope they take its tilt.
  builtin::Pile slope(1, 100, [](Vec2f at) { return 0.5f * at.x; });
  const Vec3f up = slope.settle({0.2f, 0.1f}, kRadius, kHalf, 0, rng).vector({0, 1, 0});
  EXPECT_NEAR(up.x / up.y, -0.5f, 0.01f);
  EXPECT_NEAR(up.z, 0, 0.01f);
  slope.block({0, 0}, 0.1f);
  EXPECT_TRUE(slope.isBlocked({0.05f, 0}));
  EXPECT_FALSE(slope.isBlocked({0.2f, 0}));
}

}  // namespace
}  // namespace lobelia
