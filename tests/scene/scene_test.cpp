// Bounds, counts and the hash of scenes.
#include "lobelia/scene/scene.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "support/shapes.h"

namespace lobelia {
namespace {

Scene sampleScene() {
  Scene s;
  test::place(s, test::sphereMesh(16, 8, true), translation({5, 0, 0}));
  test::place(s, test::squareMesh(), scaling({2, 3, 1}));
  s.meshes[1].attributes.push_back({"vertex_a", false, 1, {1, 2, 3, 4}});
  s.textures.resize(2);
  s.images.emplace_back();
  s.images[0].width = s.images[0].height = 1;
  s.images[0].pixels = {0.1f, 0.2f, 0.3f};
  s.emitters.emplace_back();
  s.cameras.emplace_back();
  return s;
}

TEST(Scene, BoundsAndTriangleCount) {
  const Scene s = sampleScene();
  const Bounds3f b = bounds(s);
  EXPECT_NEAR(b.hi.x, 6, 1e-5f);
  EXPECT_NEAR(b.lo.x, 0, 1e-5f);
  EXPECT_NEAR(b.hi.y, 3, 1e-5f);
  EXPECT_NEAR(b.lo.y, -1, 1e-5f);
  EXPECT_NEAR(b.lo.z, -1, 1e-5f);
  EXPECT_EQ(triangleCount(s), s.meshes[0].triangles.size() + 2);
  EXPECT_TRUE(bounds(Scene{}).empty());
}

TEST(Scene, BoundsOfVeryManyTrianglesHoldThemAll) {
  Scene s = sampleScene();
  const Bounds3f exact = bounds(s);
  s.instances.resize(50000, s.instances[0]);
  const Bounds3f loose = bounds(s);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(loose.lo[i], exact.lo[i] + 1e-6f);
    EXPECT_GE(loose.hi[i], exact.hi[i] - 1e-6f);
  }
}

TEST(SceneHash, EqualScenesHaveEqualHashes) {
  EXPECT_EQ(hash(sampleScene()), hash(sampleScene()));
  Scene named = sampleScene();
  named.name = "other", named.meshes[0].name = "other", named.findings.emplace_back();
  named.emitters[0].name = "other", named.emitters[0].group = "default";  // as without group
  EXPECT_EQ(hash(named), hash(sampleScene()));
}

TEST(SceneHash, EveryChangeCounts) {
  const std::vector<std::function<void(Scene&)>> changes{
      [](Scene&) {},
      [](Scene& s) { s.meshes[0].positions.back().z += 1e-6f; },
      [](Scene& s) { s.meshes[0].normals[3].x += 1e-6f; },
      [](Scene& s) { s.meshes[0].normals.clear(); },
      [](Scene& s) { s.meshes[1].uvs[2].y = 0.5f; },
      [](Scene& s) { std::swap(s.meshes[1].triangles[0].x, s.meshes[1].triangles[0].y); },
      [](Scene& s) { s.meshes[1].attributes[0].values[3] = 5; },
      [](Scene& s) { s.meshes[1].attributes[0].name = "vertex_b"; },
      [](Scene& s) {
        s.instances[0].toWorld = Transform(translation({5, 0, 1e-7}));
      },
      [](Scene& s) { s.instances[1].flipNormals = true; },
      [](Scene& s) { s.instances[1].material = {1}; },
      [](Scene& s) { s.instances.pop_back(); },
      [](Scene& s) { s.textures[1].scale = 2; },
      [](Scene& s) { s.textures[0].wrapU = Wrap::clamp; },
      [](Scene& s) { s.textures[0].wrapV = Wrap::clamp; },
      [](Scene& s) { s.images[0].pixels[2] = 0.4f; },
      [](Scene& s) { s.materials[0].diffuse = Rgb(0.4f); },
      [](Scene& s) { s.materials[0].diffuse = TextureHandle{0}; },
      [](Scene& s) { s.materials[0].weight = 0.25f; },
      [](Scene& s) { s.emitters[0].radiance = Rgb(2.f); },
      [](Scene& s) { s.emitters[0].group = "key"; },
      [](Scene& s) { s.emitters[0].group = "fill"; },
      [](Scene& s) { s.emitters.emplace_back(); },
      [](Scene& s) { s.emitters.emplace_back().group = "key"; },
      [](Scene& s) { s.cameras[0].fovX = 0.8f; },
      [](Scene& s) { s.cameras[0].filter = PixelFilter::box; },
      [](Scene& s) { s.hideEmitters = true; },
  };
  std::set<uint64_t> hashes;
  for (const auto& change : changes) {
    Scene s = sampleScene();
    change(s);
    hashes.insert(hash(s));
  }
  EXPECT_EQ(hashes.size(), changes.size());
}

}  // namespace
}  // namespace lobelia
