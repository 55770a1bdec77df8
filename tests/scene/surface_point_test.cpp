// Positions, normals and tangents at hits.
#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/scene/shading.h"
#include "support/shapes.h"

namespace lobelia {
namespace {

using test::place;
using test::sphereMesh;
using test::squareMesh;

const Mat4 kPlaced = translation({3, -2, 1}) * rotation({1, 2, 3}, 40) * scaling({2, 2, 2});

TEST(SurfacePoint, TransformedSquare) {
  Scene s;
  place(s, squareMesh(), kPlaced);
  const SurfacePoint at = surfacePoint(s, {1.5f, 0.25f, 0.5f, 0, 0});
  // p = 0.25 (0,0) + 0.25 (1,0) + 0.5 (1,1)
  EXPECT_NEAR(length(at.p - kPlaced.point({0.75f, 0.5f, 0})), 0, 1e-6f);
  EXPECT_NEAR(at.uv.x, 0.75f, 1e-6f);
  EXPECT_NEAR(at.uv.y, 0.5f, 1e-6f);
  EXPECT_NEAR(length(at.dpdu - kPlaced.vector({1, 0, 0})), 0, 1e-5f);
  EXPECT_NEAR(length(at.dpdv - kPlaced.vector({0, 1, 0})), 0, 1e-5f);
  EXPECT_NEAR(length(at.ng - normalize(kPlaced.vector({0, 0, 1}))), 0, 1e-6f);
  EXPECT_NEAR(length(at.frame.s - normalize(at.dpdu)), 0, 1e-6f);
  EXPECT_NEAR(length(at.frame.n - at.ng), 0, 1e-6f);
  EXPECT_EQ(at.t, 1.5f);
  EXPECT_EQ(at.texture.mesh, &s.meshes[0]);
}

TEST(SurfacePoint, FlipTurnsBothNormals) {
  Scene s;
  Mesh mesh = squareMesh();
  mesh.normals.assign(4, normalize(Vec3f(0.1f, 0.2f, 1)));
  place(s, mesh);
  const SurfacePoint a = surfacePoint(s, {1, 0.2f, 0.3f, 0, 0});
  s.instances[0].flipNormals = true;
  const SurfacePoint b = surfacePoint(s, {1, 0.2f, 0.3f, 0, 0});
  EXPECT_EQ(a.ng, -b.ng);
  EXPECT_EQ(a.frame.n, -b.frame.n);
  EXPECT_GT(a.ng.z, 0);
}

TEST(SurfacePoint, GeometricNormalAgreesWithVertexNormals) {
  Scene s;
  Mesh mesh = squareMesh();
  mesh.normals.assign(4, Vec3f(0, 0, -1));  // against the winding
  place(s, mesh);
  EXPECT_EQ(surfacePoint(s, {1, 0.2f, 0.3f, 0, 0}).ng, Vec3f(0, 0, -1));
}

TEST(SurfacePoint, MirroringKeepsTheOutside) {
  Scene s;
  place(s, sphereMesh(16, 8), scaling({-1, 1, 1}));
  for (uint32_t t = 0; t < s.meshes[0].triangles.size(); ++t) {
    const SurfacePoint at = surfacePoint(s, {1, 0.3f, 0.3f, 0, t});
    EXPECT_GT(dot(at.ng, at.p), 0);
  }
}

TEST(SurfacePoint, WithoutUvsBarycentricsAndAFrame) {
  Scene s;
  Mesh mesh = squareMesh();
  mesh.uvs.clear();
  place(s, mesh);
  const SurfacePoint at = surfacePoint(s, {1, 0.25f, 0.5f, 0, 1});
  EXPECT_EQ(at.uv, Vec2f(0.25f, 0.5f));
  EXPECT_EQ(at.dpdu, frameFromNormal(at.ng).s);
}

TEST(SurfacePoint, DegenerateUvsFallBack) {
  Scene s;
  Mesh mesh = squareMesh();
  mesh.uvs.assign(4, Vec2f(0.5f, 0.5f));
  place(s, mesh);
  const SurfacePoint at = surfacePoint(s, {1, 0.25f, 0.5f, 0, 1});
  EXPECT_EQ(at.uv, Vec2f(0.5f, 0.5f));
  EXPECT_EQ(at.dpdu, frameFromNormal(at.ng).s);
  EXPECT_TRUE(isFinite(at.frame.s));
}

TEST(SurfaceNormals, AreThoseOfTheSurfacePoint) {
  for (const bool smooth : {false, true})
    for (const bool flipped : {false, true})
      for (const Vec3d scale : {Vec3d(1, 1, 1), Vec3d(-1, 2, 1), Vec3d(1, 0.2, 3)}) {
        Scene s;
        Mesh mesh = sphereMesh(8, 5);
        if (!smooth) mesh.normals.clear();
        mesh.triangles.emplace_back(0u, 0u, 1u);  // degenerate
        place(s, mesh, scaling(scale));
        s.instances[0].flipNormals = flipped;
        for (uint32_t t = 0; t < s.meshes[0].triangles.size(); ++t) {
          const Hit hit{1, 0.2f, 0.5f, 0, t};
          const SurfacePoint at = surfacePoint(s, hit);
          const SurfaceNormals normals = surfaceNormals(s, hit);
          EXPECT_EQ(normals.ng, at.ng) << t;
          EXPECT_EQ(normals.n, at.frame.n) << t;
        }
      }
}

TEST(SurfacePoint, TinyAndDegenerateTrianglesGiveFiniteNormals) {
  Scene s;
  Mesh mesh = squareMesh();
  for (Vec3f& p : mesh.positions) p *= 1e-18f;
  mesh.triangles.emplace_back(0u, 0u, 1u);
  place(s, mesh);
  EXPECT_NEAR(length(surfacePoint(s, {1, 0.3f, 0.3f, 0, 0}).ng - Vec3f(0, 0, 1)), 0, 1e-6f);
  const SurfacePoint at = surfacePoint(s, {1, 0.3f, 0.3f, 0, 2});
  EXPECT_NEAR(length(at.ng), 1, 1e-6f);
  EXPECT_TRUE(isFinite(at.frame.s));
  EXPECT_TRUE(std::isfinite(at.error));
}

TEST(SurfacePoint, ErrorIsAboutAMillionthOfTheCoordinates) {
  Rng rng(1);
  for (const double offset : {0., 1., 1000.}) {
    Scene s;
    place(s, sphereMesh(32, 16), translation({offset, offset, -offset}) * rotation({1, 1, 0}, 30));
    for (uint32_t t = 0; t < s.meshes[0].triangles.size(); ++t) {
      const float error = surfacePoint(s, {1, 0.3f, 0.3f, 0, t}).error;
      EXPECT_GT(error, 0);
      EXPECT_LT(error, 2e-6 * (1 + offset));
    }
  }
}

TEST(SurfacePoint, OffsetGoesToTheSideOfTheDirection) {
  const Vec3f n{0, 0, 1};
  EXPECT_GT(offsetOrigin({1, 2, 3}, n, 1e-3f, {1, 0, 0.1f}).z, 3);
  EXPECT_LT(offsetOrigin({1, 2, 3}, n, 1e-3f, {1, 0, -0.1f}).z, 3);
}

TEST(Opacity, FollowsTheTreeOfMaterials) {
  Scene s;
  s.materials.resize(6);
  s.materials[1].type = MaterialType::mask;
  s.materials[1].a = {0}, s.materials[1].opacity = 0.25f;
  s.materials[2].type = MaterialType::null;
  s.materials[3].type = MaterialType::blend;
  s.materials[3].a = {1}, s.materials[3].b = {2}, s.materials[3].weight = 0.5f;
  s.materials[4].type = MaterialType::twoSided;
  s.materials[4].a = {3};
  s.materials[5].type = MaterialType::mask;
  s.materials[5].a = {0}, s.materials[5].opacity = 1.f;
  const auto value = [&](uint32_t i) { return opacity(s, MaterialHandle{i}, {}); };
  EXPECT_EQ(value(0), 1);
  EXPECT_EQ(value(1), 0.25f);
  EXPECT_EQ(value(2), 0);
  EXPECT_EQ(value(3), 0.125f);
  EXPECT_EQ(value(4), 0.125f);
  EXPECT_FALSE(hasOpacity(s, MaterialHandle{0}));
  EXPECT_TRUE(hasOpacity(s, MaterialHandle{1}));
  EXPECT_TRUE(hasOpacity(s, MaterialHandle{4}));
  EXPECT_FALSE(hasOpacity(s, MaterialHandle{5}));
  EXPECT_FALSE(hasOpacity(s, {}));
}

}  // namespace
}  // namespace lobelia
