// Triangles look to the side that their shading normals say: one that is turned over shows the
// inside of its body, which is black.
#include <gtest/gtest.h>

#include "lobelia/builtin/builtin_scenes.h"

namespace lobelia {
namespace {

// Triangles whose own normal is behind the mean of their corners'.
size_t turnedOver(const Mesh& mesh) {
  size_t count = 0;
  for (const Vec3u& t : mesh.triangles) {
    const Vec3f a = mesh.positions[t.x],
                ng = cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
    count += dot(ng, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) < 0 ? 1 : 0;
  }
  return count;
}

TEST(Facing, RimsOfGlassesAreNotTurnedOver) {
  for (const float detail : {0.2f, 0.4f, 0.5f, 1.f}) {
    const Scene scene = builtin::builtinScene("glasses", detail);
    size_t vessels = 0;
    for (const Mesh& mesh : scene.meshes) {
      if (mesh.normals.empty()) continue;
      ++vessels;
      EXPECT_EQ(turnedOver(mesh), 0u) << mesh.name << ", detail " << detail;
    }
    EXPECT_GE(vessels, 4u);
  }
}

}  // namespace
}  // namespace lobelia
