// PBRT files: shapes.
#include <gtest/gtest.h>

#include <cmath>

#include "io/pbrt_scene.h"
#include "lobelia/io/mesh_io.h"
#include "lobelia/io/pbrt/tessellation.h"

namespace lobelia::test {
namespace {

const Mesh& onlyMesh(const Scene& scene) { return scene[scene.instances.at(0).mesh]; }

double areaOf(const Mesh& mesh) {
  double area = 0;
  for (const Vec3u t : mesh.triangles)
    area += 0.5 * static_cast<double>(length(cross(mesh.positions[t.y] - mesh.positions[t.x],
                                                   mesh.positions[t.z] - mesh.positions[t.x])));
  return area;
}

// All triangles turn with their vertex normals.
void expectConsistent(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Vec3u t : mesh.triangles) {
    const Vec3f n =
        cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    EXPECT_GT(dot(n, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]), 0);
  }
}

TEST(PbrtShapes, RoundOnes) {
  const Scene whole = readPbrtWorld("Shape \"sphere\" \"float radius\" 2");
  EXPECT_TRUE(onlyMesh(whole).isUnitSphere);
  EXPECT_NEAR(whole.instances[0].toWorld.vector({0, 0, 1}).z, 2, 1e-6);
  const Mesh& unit = onlyMesh(whole);
  for (size_t i = 0; i < unit.positions.size(); ++i)
    EXPECT_NEAR(unit.uvs[i].y, 1 - std::acos(std::clamp(unit.positions[i].z, -1.f, 1.f)) / kPi,
                1e-3f);

  const Mesh cap =
      onlyMesh(readPbrtWorld("Shape \"sphere\" \"float radius\" 2 \"float zmin\" 0 "
                             "\"float phimax\" 180"));
  EXPECT_NEAR(areaOf(cap), 2 * M_PI * 2 * 2 / 2, 0.01);
  expectConsistent(cap);
  const Mesh disk =
      onlyMesh(readPbrtWorld("Shape \"disk\" \"float radius\" 2 \"float innerradius\" "
                             "1 \"float height\" 3"));
  EXPECT_NEAR(areaOf(disk), 3 * M_PI, 0.01);
  EXPECT_FLOAT_EQ(disk.positions[0].z, 3);
  expectConsistent(disk);
  const Mesh tube =
      onlyMesh(readPbrtWorld("Shape \"cylinder\" \"float radius\" 1 \"float zmin\" -1 "
                             "\"float zmax\" 2 \"float phimax\" 90"));
  EXPECT_NEAR(areaOf(tube), 3 * M_PI / 2, 0.01);
  expectConsistent(tube);
}

TEST(PbrtShapes, Meshes) {
  const Mesh triangle = onlyMesh(readPbrtWorld(kTriangle));
  EXPECT_EQ(triangle.triangles.size(), 1u);
  EXPECT_TRUE(triangle.normals.empty());  // flat
  const Mesh quad = onlyMesh(
      readPbrtWorld("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"integer "
                    "indices\" [0 1 2 0 2 "
                    "3] \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1] \"point2 uv\" [0 0 1 0 1 1 0 1]"));
  EXPECT_EQ(quad.triangles.size(), 2u);
  EXPECT_EQ(quad.normals.size(), 4u);
  EXPECT_FLOAT_EQ(quad.uvs[2].y, 1);
  const Mesh flat =
      onlyMesh(readPbrtWorld("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0 2 1 0]"));
  EXPECT_EQ(flat.triangles.size(), 2u);
  expectConsistent(flat);
  EXPECT_GT(flat.normals[0].z, 0.9f);
  const Mesh saddle =
      onlyMesh(readPbrtWorld("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 1 0 1 1 1 1 0]"));
  EXPECT_GT(saddle.triangles.size(), 100u);
  // Area of z = x + y - 2 x y over the unit square by midpoints.
  double area = 0;
  constexpr int kN = 200;
  for (int i = 0; i < kN * kN; ++i) {
    const double x = (i % kN + .5) / kN, y = (i / kN + .5) / kN;
    area += std::sqrt(1 + (1 - 2 * y) * (1 - 2 * y) + (1 - 2 * x) * (1 - 2 * x)) / (kN * kN);
  }
  EXPECT_NEAR(areaOf(saddle), area, 2e-3);
  EXPECT_TRUE(contains(pbrtRefusal("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
                                   "\"integer indices\" [0 1 7]"),
                       "there are 3 points"));
  EXPECT_TRUE(
      contains(pbrtRefusal("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1]"), "multiple of 3"));
  EXPECT_TRUE(contains(pbrtRefusal("Shape \"trianglemesh\""), "no 'point3 P'"));
  EXPECT_TRUE(contains(pbrtRefusal("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "
                                   "\"point2 uv\" [0 0]"),
                       "1 values of 'uv' for 3 vertices"));
  EXPECT_TRUE(contains(pbrtRefusal("Shape \"plymesh\""), "no filename"));
  EXPECT_TRUE(contains(findingsOf(readPbrtWorld("Shape \"curve\" \"float width\" 1")), "curve"));
}

TEST(PbrtShapes, PlyMeshesAreSharedAndFlatWithoutNormals) {
  const TemporaryFolder folder;
  folder.write("t.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Scene scene = readPbrtText(folder,
                                   "WorldBegin Shape \"plymesh\" \"string filename\" "
                                   "\"t.ply\" Shape \"plymesh\" \"string filename\" "
                                   "\"t.ply\"");
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_TRUE(onlyMesh(scene).normals.empty());
  folder.write("bad.ply", "ply\nformat ascii 1.0\nend_header\n");
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] {
        readPbrtText(folder, "WorldBegin Shape \"plymesh\" \"string filename\" \"bad.ply\"");
      }),
      "bad.ply"));
}

// An octahedron's limit surface: the control points' limit lies on the axes at the distance that
// the mask 1 / (n + 3 / (8 beta)) gives, 2/3 of the vertex and none of the ring.
TEST(PbrtShapes, LoopSubdivisionReachesTheLimit) {
  Mesh octahedron;
  octahedron.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const uint32_t x : {0u, 1u})
    for (const uint32_t y : {2u, 3u})
      for (const uint32_t z : {4u, 5u}) {
        const bool turn = ((x & 1u) + (y & 1u) + (z & 1u)) % 2 == 1;
        octahedron.triangles.push_back(turn ? Vec3u(x, z, y) : Vec3u(x, y, z));
      }
  for (int levels = 0; levels <= 3; ++levels) {
    const Mesh fine = io::pbrt::subdivideLoop(octahedron, levels);
    EXPECT_EQ(fine.triangles.size(), size_t{8} << (2 * levels));
    // valence 4: beta = 3/32, weight of the ring 1 / (4 + 4) each, of the vertex 1 - 4/8.
    expectNear(fine.positions[0], {0.5f, 0, 0}, 1e-5f);
    expectConsistent(fine);
  }
  // A flat square stays flat, its boundary in the plane.
  const Mesh square = onlyMesh(readPbrtWorld(
      "Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] "
      "\"integer indices\" [0 1 2 0 2 3]"));
  EXPECT_EQ(square.triangles.size(), 32u);
  for (const Vec3f& p : square.positions) EXPECT_EQ(p.z, 0);
  EXPECT_TRUE(
      contains(pbrtRefusal("Shape \"loopsubdiv\" \"integer levels\" 99 \"point3 P\" [0 0 0 1 "
                           "0 0 1 1 0] \"integer indices\" [0 1 2]"),
               "levels"));
}

}  // namespace
}  // namespace lobelia::test
