#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/io/mesh_io.h"

namespace lobelia {
namespace {

double area(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3u& t : mesh.triangles)
    sum += 0.5 * static_cast<double>(length(cross(mesh.positions[t.y] - mesh.positions[t.x],
                                                  mesh.positions[t.z] - mesh.positions[t.x])));
  return sum;
}

// Faces and vertex normals agree, normals are unit, and no triangle is degenerate.
void expectSound(const Mesh& mesh) {
  for (const Vec3u& t : mesh.triangles) {
    const Vec3f n =
        cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    ASSERT_GT(length(n), 0) << mesh.name;
    for (int c = 0; c < 3; ++c)
      ASSERT_GT(dot(n, mesh.normals[t[c]]), 0.99f * length(n)) << mesh.name;
  }
  for (const Vec3f n : mesh.normals) ASSERT_NEAR(length(n), 1, 1e-6f);
}

TEST(UnitShapes, AreSoundAndOfTheRightArea) {
  const struct {
    Mesh mesh;
    double area;
  } shapes[] = {{io::unitRectangle(), 4},
                {io::unitCube(), 24},
                {io::unitDisk(), M_PI},
                {io::unitSphere(), 4 * M_PI},
                {io::unitCylinder(), 2 * M_PI}};
  for (const auto& [mesh, expected] : shapes) {
    expectSound(mesh);
    EXPECT_NEAR(area(mesh) / expected, 1, 2e-4) << mesh.name;
    EXPECT_EQ(mesh.isUnitSphere, mesh.name == "sphere");
  }
}

TEST(UnitShapes, SphereLiesOnTheSphereWithMitsubasUv) {
  const Mesh mesh = io::unitSphere();
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f p = mesh.positions[i];
    ASSERT_NEAR(length(p), 1, 1e-6f);
    ASSERT_EQ(p, mesh.normals[i]);
    const float theta = mesh.uvs[i].y * kPi, phi = mesh.uvs[i].x * kTwoPi;
    ASSERT_NEAR(p.x, std::sin(theta) * std::cos(phi), 2e-6f);
    ASSERT_NEAR(p.y, std::sin(theta) * std::sin(phi), 2e-6f);
    ASSERT_NEAR(p.z, std::cos(theta), 2e-6f);
  }
  // Silhouette: the farthest that any chord of the mesh is inside the sphere.
  float least = 1;
  for (const Vec3u& t : mesh.triangles)
    least = std::min(least, length((mesh.positions[t.x] + mesh.positions[t.y]) * 0.5f));
  EXPECT_GT(least, 1 - 1.6e-4f);
}

TEST(UnitShapes, DiskAndCylinderHaveMitsubasUv) {
  const Mesh disk = io::unitDisk(), cylinder = io::unitCylinder();
  for (size_t i = 0; i < disk.positions.size(); ++i) {
    const Vec2f uv = disk.uvs[i];
    ASSERT_NEAR(disk.positions[i].x, uv.x * std::cos(uv.y * kTwoPi), 2e-6f);
    ASSERT_NEAR(disk.positions[i].y, uv.x * std::sin(uv.y * kTwoPi), 2e-6f);
  }
  for (size_t i = 0; i < cylinder.positions.size(); ++i) {
    const Vec2f uv = cylinder.uvs[i];
    ASSERT_NEAR(cylinder.positions[i].x, std::cos(uv.x * kTwoPi), 2e-6f);
    ASSERT_NEAR(cylinder.positions[i].y, std::sin(uv.x * kTwoPi), 2e-6f);
    ASSERT_EQ(cylinder.positions[i].z, uv.y);
  }
}

TEST(UnitShapes, RectangleAndCubeUv) {
  const Mesh rectangle = io::unitRectangle();
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(rectangle.positions[i],
              Vec3f(2 * rectangle.uvs[i].x - 1, 2 * rectangle.uvs[i].y - 1, 0));
  // Mitsuba's cube, of which two corners tell the orientation on each face.
  const Mesh cube = io::unitCube();
  ASSERT_EQ(cube.positions.size(), 24u);
  const Vec3f first[] = {{1, -1, -1}, {1, 1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {1, 1, -1}};
  const Vec3f second[] = {{1, -1, 1}, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}, {1, -1, -1}};
  for (size_t f = 0; f < 6; ++f) {
    EXPECT_EQ(cube.positions[4 * f], first[f]);
    EXPECT_EQ(cube.uvs[4 * f], Vec2f(0, 1));
    EXPECT_EQ(cube.positions[4 * f + 1], second[f]);
    EXPECT_EQ(cube.uvs[4 * f + 1], Vec2f(1, 1));
  }
}

}  // namespace
}  // namespace lobelia
