// The camera of scenes that have none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lobelia/io/mesh_io.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::io {
namespace {

Scene square(const Mat4& toWorld) {
  Scene scene;
  scene.meshes.push_back(unitRectangle());
  Instance instance;
  instance.mesh = {0};
  instance.toWorld = Transform(toWorld);
  scene.instances.push_back(instance);
  addDefaultView(scene);
  return scene;
}

// The largest part of the film's half width or height that a vertex needs, 1 at the film's edge.
float filled(const Scene& scene) {
  const Camera& camera = scene.cameras.at(0);
  const float tanX = std::tan(camera.fovX / 2);
  const float tanY = tanX * static_cast<float>(camera.height) / static_cast<float>(camera.width);
  float most = 0;
  for (const Vec3f p : scene.meshes[0].positions) {
    const Vec3f q = camera.toWorld.inverted().point(scene.instances[0].toWorld.point(p));
    EXPECT_GT(q.z, camera.nearClip);
    most = std::max({most, std::abs(q.x) / (q.z * tanX), std::abs(q.y) / (q.z * tanY)});
  }
  return most;
}

TEST(DefaultView, FillsTheFilm) {
  const Mat4 floor = rotation({1, 0, 0}, -90);
  for (const Mat4& place : {floor, translation({300, -20, 5000}) * floor, scaling(Vec3d(1e-4)),
                            rotation({0, 1, 0}, 90) * scaling({40, 1, 1})}) {
    const float part = filled(square(place));
    EXPECT_LT(part, 1);
    EXPECT_GT(part, 0.85f);
  }
}

TEST(DefaultView, SeesFlatThingsFromTheirFront) {
  for (const double turn : {0., 180.}) {
    const Scene scene = square(rotation({0, 1, 0}, turn));
    const Vec3f forward = scene.cameras.at(0).toWorld.vector({0, 0, 1});
    const Vec3f normal = scene.instances[0].toWorld.vector({0, 0, 1});
    EXPECT_LT(dot(forward, normal), -0.99f);
  }
}

}  // namespace
}  // namespace lobelia::io
