#include <fmt/format.h>

#include "io/temporary_folder.h"
#include "lobelia/io/mesh_io.h"
#include "support/data.h"

namespace lobelia {
namespace {

class Obj : public testing::Test {
 protected:
  Mesh read(const std::string& text, const io::MeshOptions& options = {}) {
    findings.clear();
    return io::readObj(folder.write("mesh.obj", text), options, {}, findings);
  }
  // The message must name the file and line.
  void expectError(const std::string& text, int line, const std::string& part) {
    const std::string message = messageOf<InputError>([&] { read(text); });
    const std::string place = "mesh.obj" + (line > 0 ? fmt::format(":{}", line) : "") + ": ";
    EXPECT_TRUE(contains(message, place)) << message;
    EXPECT_TRUE(contains(message, part)) << message;
  }
  TemporaryFolder folder;
  std::vector<Finding> findings;
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(Obj, ReadsQuadAsFanWithComputedNormals) {
  const Mesh mesh = read(kSquare + "f 1 2 3 4\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], Vec3u(0, 1, 2));
  EXPECT_EQ(mesh.triangles[1], Vec3u(0, 2, 3));
  ASSERT_EQ(mesh.normals.size(), 4u);
  for (const Vec3f n : mesh.normals) EXPECT_EQ(n, Vec3f(0, 0, 1));
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_EQ(mesh.name, "mesh");
  EXPECT_TRUE(findings.empty());
}

TEST_F(Obj, FaceNormalsOptionDropsNormals) {
  io::MeshOptions options;
  options.faceNormals = true;
  EXPECT_TRUE(read(kSquare + "vn 0 0 1\nf 1//1 2//1 3//1\n", options).normals.empty());
}

TEST_F(Obj, NegativeIndicesCountFromTheEnd) {
  const Mesh mesh = read(kSquare + "f -4 -3 -2\nv 5 5 5\nf -1 1 2\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.positions[mesh.triangles[0].x], Vec3f(0, 0, 0));
  EXPECT_EQ(mesh.positions[mesh.triangles[0].z], Vec3f(1, 1, 0));
  EXPECT_EQ(mesh.positions[mesh.triangles[1].x], Vec3f(5, 5, 5));
}

TEST_F(Obj, EqualTriplesShareAVertexOthersDoNot) {
  const std::string text = kSquare +
                           "vt 0 0.25\nvt 1 0.25\nvn 0 0 2\nvn 0 1 0\n"
                           "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\nf 1/2/1 3/1/2 4/1/1\n";
  const Mesh mesh = read(text);
  EXPECT_EQ(mesh.positions.size(), 6u);  // 4 and two new triples in the last face
  EXPECT_EQ(mesh.triangles[1], Vec3u(0, 2, 3));
  EXPECT_EQ(mesh.uvs[0], Vec2f(0, 0.75f));     // flipped by default
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));  // made unit
  io::MeshOptions options;
  options.flipTexCoords = false;
  EXPECT_EQ(read(text, options).uvs[0], Vec2f(0, 0.25f));
}

TEST_F(Obj, VerticesWithoutNormalGetOne) {
  const Mesh mesh = read(kSquare + "vn 1 0 0\nf 1//1 2 3\n");
  EXPECT_EQ(mesh.normals[0], Vec3f(1, 0, 0));
  EXPECT_EQ(mesh.normals[1], Vec3f(0, 0, 1));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_TRUE(contains(findings[0].message, "2 of 3 vertex normals")) << findings[0].message;
}

TEST_F(Obj, LineEndsContinuationsAndComments) {
  const Mesh dos = read("v 0 0 0 # here\r\nv 1 0 0\r\nv 1 1 0\r\nf 1 \\\r\n 2 3\r\n");
  EXPECT_EQ(dos.triangles.size(), 1u);
  const Mesh mac = read("v 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3");
  EXPECT_EQ(mac.triangles.size(), 1u);
  expectError("v 0 0 0\nv 1 0 \\\n0\nv 1 1 0\nf 1 2 x\n", 5, "'x' is not a vertex");
}

TEST_F(Obj, NumbersOfAllForms) {
  const Mesh mesh = read("v +1.5e1 -.5 1e-60\nv 3. 1E2 0\nv 0 0 -7.25e-01\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], Vec3f(15, -0.5f, 0));
  EXPECT_EQ(mesh.positions[1], Vec3f(3, 100, 0));
  EXPECT_EQ(mesh.positions[2], Vec3f(0, 0, -0.725f));
}

// validate() reports them, for meshes of any origin.
TEST_F(Obj, DegenerateTrianglesAreKept) {
  const Mesh mesh = read(kSquare + "f 1 2 3\nf 1 2 2\nf 1 1 1\n");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_TRUE(findings.empty());
}

TEST_F(Obj, UnknownStatementIsAWarningWithItsLine) {
  read(kSquare + "wobble 3\nf 1 2 3\n");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].where.line, 5);
  EXPECT_TRUE(contains(findings[0].message, "'wobble'"));
}

TEST_F(Obj, ErrorsNameFileAndLine) {
  expectError("v 0 0 0\nv 1 nan 0\n", 2, "'nan' is not a finite number");
  expectError("v 0 0 0\nv 1 1e99 0\n", 2, "1e99");
  expectError("v 0 0 0\nv inf 0 0\n", 2, "inf");
  expectError("v 0 0 0\nv 1 2\n", 2, "2 numbers after 'v'");
  expectError("v 0 0 0\nv 1 2 3abc\n", 2, "3abc");
  expectError("vn 0 0\n", 1, "'vn'");
  expectError(kSquare + "f 1 2 9\n", 5, "there is no vertex 9; 4 are defined");
  expectError(kSquare + "f 1 2 -5\n", 5, "there is no vertex -5");
  expectError(kSquare + "f 1/1 2/1 3/1\n", 5, "there is no uv 1");
  expectError(kSquare + "f 1//1 2//1 3//1\n", 5, "there is no normal 1");
  expectError(kSquare + "f 1 2 0\n", 5, "'0'");
  expectError(kSquare + "f 1 2 99999999999999\n", 5, "99999999999999");
  expectError(kSquare + "f 1/2/3/4 2 3\n", 5, "1/2/3/4");
  expectError(kSquare + "f 1/ 2 3\n", 5, "1/");
  expectError(kSquare + "f 1 2\n", 5, "2 vertices");
  expectError(kSquare + "f 1 2 3\nv 1 2", 6, "2 numbers");
}

TEST_F(Obj, FilesWithoutFacesAreErrors) {
  expectError("", 0, "no faces");
  expectError(kSquare, 0, "no faces");
  expectError(std::string("\0\1\2\n\3\377", 6), 0, "no faces");
}

TEST_F(Obj, MissingFileIsAnErrorAtThePlaceThatNamesIt) {
  const std::string message = messageOf<InputError>([&] {
    io::readObj(folder.path("gone.obj"), {}, {"scene.xml", 12, 0}, findings);
  });
  EXPECT_TRUE(contains(message, "scene.xml:12")) << message;
  EXPECT_TRUE(contains(message, "gone.obj")) << message;
  messageOf<InputError>([&] { io::readObj(folder.path(""), {}, {}, findings); });  // a folder
}

// The angle-weighted mean does not depend on how a face is cut into triangles.
TEST_F(Obj, CornerOfACubeHasTheDiagonalAsSmoothNormal) {
  const Mesh mesh = read(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
      "f 1 4 3 2\nf 1 2 6 5\nf 1 5 7 4\n");
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mesh.normals[0][i], -1 / std::sqrt(3.f), 1e-6f);
}

TEST_F(Obj, SmoothAngleSplitsSharpEdgesOnly) {
  // Two pairs of triangles: flat within a pair, 90 degrees between the pairs.
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nf 1 2 3 4\nf 2 1 5 6\n";
  io::MeshOptions options;
  options.maxSmoothAngle = 45;
  const Mesh split = read(text, options);
  EXPECT_EQ(split.positions.size(), 8u);
  for (const Vec3u& t : split.triangles) {
    const Vec3f n = normalize(cross(split.positions[t.y] - split.positions[t.x],
                                    split.positions[t.z] - split.positions[t.x]));
    for (int c = 0; c < 3; ++c) EXPECT_EQ(split.normals[t[c]], n);
  }
  options.maxSmoothAngle = 120;
  EXPECT_EQ(read(text, options).positions.size(), 6u);
}

TEST_F(Obj, RealMeshes) {
  const std::string data = test::sharedFolder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  const struct {
    const char* name;
    size_t triangles;
  } meshes[] = {{"stanford-bunny.obj", 69451},
                {"happy-buddha.obj", 100000},
                {"utah-teapot.obj", 25200},
                {"suzanne.obj", 968}};
  for (const auto& [name, triangles] : meshes) {
    findings.clear();
    const Mesh mesh = io::readObj(data + "/data/meshes/" + name, {}, {}, findings);
    EXPECT_EQ(mesh.triangles.size(), triangles) << name;
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_TRUE(findings.empty()) << findings[0].message;
  }
}

}  // namespace
}  // namespace lobelia
