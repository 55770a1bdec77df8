// Vertices of transfer: one for each way to reflect light at a place.
#include "lobelia/transfer/transfer_mesh.h"

#include <gtest/gtest.h>

#include "lobelia/relight/vertex_faces.h"
#include "relight/scenes.h"

namespace lobelia::transfer {
namespace {

using test::place;

Material wrapping(MaterialType type, MaterialHandle inner) {
  Material m;
  m.type = type, m.a = inner;
  return m;
}

TextureHandle addTexture(Scene& scene) {
  Texture t;
  t.type = TextureType::checkerboard;
  scene.textures.push_back(t);
  return {static_cast<uint32_t>(scene.textures.size() - 1)};
}

size_t vertexCount(const Scene& scene) { return splitMesh(scene).positions().size(); }

TEST(IsTextured, LooksAtEveryParameterAndInsideOfWrappers) {
  Scene scene;
  const TextureHandle texture = addTexture(scene);
  const MaterialHandle plain = test::addMaterial(scene, {});
  EXPECT_FALSE(isTextured(scene, plain));
  EXPECT_FALSE(isTextured(scene, {}));
  Material rough;
  rough.alphaU = texture;
  const MaterialHandle inner = test::addMaterial(scene, rough);
  EXPECT_TRUE(isTextured(scene, inner));
  EXPECT_TRUE(isTextured(scene, test::addMaterial(scene, wrapping(MaterialType::twoSided, inner))));
  EXPECT_FALSE(isTextured(scene, test::addMaterial(scene, wrapping(MaterialType::mask, plain))));
  Material bump = wrapping(MaterialType::bump, plain);
  bump.map = texture;
  EXPECT_TRUE(isTextured(scene, test::addMaterial(scene, bump)));
  Material captured;
  captured.capturedLobes.emplace_back();
  captured.capturedLobes[0].sharpness = texture;
  EXPECT_TRUE(isTextured(scene, test::addMaterial(scene, captured)));
}

TEST(SplitMesh, ASmoothSphereHasTheVerticesOfItsPlaces) {
  Scene scene;
  place(scene, test::sphereMesh(100, 100, true), scaling({0.37, 0.37, 0.37}));
  ASSERT_EQ(scene.meshes[0].triangles.size(), 19800u);
  EXPECT_EQ(vertexCount(scene), relight::weldedMesh(scene).positions().size());
  EXPECT_LE(vertexCount(scene), 99u * 100 + 2 + 20);
}

TEST(SplitMesh, ABoxHasThreeVerticesAtEachCorner) {
  Scene scene;
  place(scene, test::boxMesh({-1, -1, -1}, {1, 1, 1}));
  EXPECT_EQ(vertexCount(scene), 24u);
  EXPECT_EQ(relight::weldedMesh(scene).positions().size(), 8u);
}

TEST(SplitMesh, ATurnedPlaneStaysOne) {
  // The normals of its triangles differ by rounding, and lie on any side of any cell's border.
  for (int turn = 0; turn < 50; ++turn) {
    Scene scene;
    place(scene, test::groundMesh(8), rotation({1, 0.3, 0.2}, 7.3 * turn) * scaling({0.7, 1.3, 1}));
    EXPECT_EQ(vertexCount(scene), relight::weldedMesh(scene).positions().size());
  }
}

TEST(SplitMesh, MaterialsThatMeetHaveVerticesOfTheirOwn) {
  Scene scene;
  const MaterialHandle one = test::addMaterial(scene, {}), other = test::addMaterial(scene, {});
  test::addQuad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, one);
  test::addQuad(scene, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, other);
  EXPECT_EQ(vertexCount(scene), 8u);
  scene.instances[1].material = one;
  EXPECT_EQ(vertexCount(scene), 6u);
  scene.instances[1].flipNormals = true;
  EXPECT_EQ(vertexCount(scene), 8u);
}

TEST(SplitMesh, SeamsCountOnlyForTexturedMaterials) {
  Scene scene;
  const MaterialHandle plain = test::addMaterial(scene, {});
  Material material;
  material.diffuse = addTexture(scene);
  const MaterialHandle textured = test::addMaterial(scene, material);
  place(scene, test::squareMesh());
  place(scene, test::squareMesh(), translation({1, 0, 0}));  // u starts again
  EXPECT_EQ(vertexCount(scene), 6u);
  for (Instance& instance : scene.instances) instance.material = textured;
  EXPECT_EQ(vertexCount(scene), 8u);
  for (Vec2f& uv : scene.meshes[1].uvs) uv.x += 1;
  EXPECT_EQ(vertexCount(scene), 6u);
  // Attributes of faces.
  scene.meshes[0].attributes.push_back({"face_color", true, 1, {0.25f, 0.75f}});
  EXPECT_EQ(vertexCount(scene), 10u) << "two at each end of the diagonal, none in common";
  for (Instance& instance : scene.instances) instance.material = plain;
  EXPECT_EQ(vertexCount(scene), 6u);
}

TEST(SplitMesh, TangentsCountForAnisotropicMaterials) {
  Scene scene;
  Material brushed;
  brushed.type = MaterialType::roughConductor;
  brushed.alphaU = 0.05f, brushed.alphaV = 0.2f;
  test::addMaterial(scene, brushed);
  place(scene, test::squareMesh());
  place(scene, test::squareMesh(), translation({1, 0, 0}));
  EXPECT_EQ(vertexCount(scene), 6u);
  for (Vec2f& uv : scene.meshes[1].uvs) uv = {uv.y, -uv.x};
  EXPECT_EQ(vertexCount(scene), 8u);
  scene.materials[0].alphaV = 0.05f;
  EXPECT_EQ(vertexCount(scene), 6u);
}

TEST(SplitMesh, TrianglesWithoutAreaAddNoVertices) {
  Scene scene;
  Mesh mesh = test::squareMesh();
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});
  place(scene, mesh);
  EXPECT_EQ(vertexCount(scene), 4u);
}

TEST(TransferVertices, AreWhereTheMeshHasThemWithTheirOwnNormals) {
  Scene scene = test::ballScene(4);
  place(scene, test::boxMesh({-1, -1, 1}, {1, 1, 2}), rotation({1, 0, 0}, 17));
  const relight::SampleMesh mesh = splitMesh(scene);
  const size_t before = mesh.positions().size();
  EXPECT_EQ(before, 25u + 24 * 11 + 2 + 24);
  const std::vector<TransferVertex> vertices = transferVertices(scene, mesh);
  ASSERT_EQ(vertices.size(), before);
  for (const relight::LeafTriangle& t : relight::leafTriangles(mesh))
    for (size_t k = 0; k < 3; ++k) {
      const TransferVertex& v = vertices[t.vertex[k]];
      EXPECT_LT(length(v.p - mesh.positions()[t.vertex[k]]), 1e-5f);
      const SurfacePoint at =
          surfacePoint(scene, {0, t.corner[k].x, t.corner[k].y, t.instance, t.triangle});
      EXPECT_EQ(scene.instances[v.instance].material, at.material);
      EXPECT_LT(length(v.n - at.frame.n), 1e-3f);
    }
}

}  // namespace
}  // namespace lobelia::transfer
