#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "io/temporary_folder.h"
#include "lobelia/io/mesh_io.h"
#include "support/data.h"

namespace lobelia {
namespace {

class Ply : public testing::Test {
 protected:
  Mesh read(const std::string& bytes, const io::MeshOptions& options = {}) {
    findings.clear();
    return io::readPly(folder.write("mesh.ply", bytes), options, {}, findings);
  }
  void expectError(const std::string& text, const std::string& place, const std::string& part) {
    const std::string message = messageOf<InputError>([&] { read(text); });
    EXPECT_TRUE(contains(message, "mesh.ply" + place + ": ")) << message;
    EXPECT_TRUE(contains(message, part)) << message;
  }
  TemporaryFolder folder;
  std::vector<Finding> findings;
};

const std::string kAscii =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty double z\nproperty float s\nproperty float t\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float heat_x\n"
    "property float heat_y\nproperty float lone\nelement face 1\n"
    "property list uchar int vertex_indices\nproperty float tag_r\nproperty float tag_g\n"
    "property float tag_b\nelement other 1\nproperty list int float stuff\nend_header\n"
    "0 0 0 0 0.25 255 0 51 1 2 9\n1 0 0 1 0 0 0 0 3 4 8\n1 1 0 1 1 0 0 0 5 6 7\n"
    "0 1 0 0 1 0 0 0 7 8 6\n4 0 1 2 3 .1 .2 .3\n2 5 5\n";

const MeshAttribute& attribute(const Mesh& mesh, const std::string& name) {
  for (const MeshAttribute& a : mesh.attributes)
    if (a.name == name) return a;
  throw std::runtime_error("no attribute " + name);
}

TEST_F(Ply, AsciiWithAttributesAndPolygon) {
  const Mesh mesh = read(kAscii);
  EXPECT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], Vec3u(0, 2, 3));
  EXPECT_EQ(mesh.uvs[0], Vec2f(0, 0.25f));  // not flipped by default
  EXPECT_EQ(mesh.normals[3], Vec3f(0, 0, 1));
  const MeshAttribute& color = attribute(mesh, "vertex_color");
  EXPECT_EQ(color.size, 3);
  EXPECT_EQ(color.values[0], 1);
  EXPECT_EQ(color.values[1], 0);
  EXPECT_NEAR(color.values[2], 0.033104766f, 1e-7f);  // 0.2 decoded from sRGB
  const MeshAttribute& heat = attribute(mesh, "vertex_heat");
  EXPECT_EQ(heat.size, 2);
  EXPECT_EQ(heat.values, (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(attribute(mesh, "vertex_lone").size, 1);
  const MeshAttribute& tag = attribute(mesh, "face_tag_color");
  EXPECT_TRUE(tag.perFace);
  EXPECT_EQ(tag.values, (std::vector<float>{.1f, .2f, .3f, .1f, .2f, .3f}));  // once a triangle
  EXPECT_TRUE(findings.empty());
}

TEST_F(Ply, OptionsFlipAndFaceNormals) {
  io::MeshOptions options;
  options.flipTexCoords = true;
  options.faceNormals = true;
  const Mesh mesh = read(kAscii, options);
  EXPECT_EQ(mesh.uvs[0], Vec2f(0, 0.75f));
  EXPECT_TRUE(mesh.normals.empty());
}

template <class T>
std::string bytesOf(T value, bool bigEndian) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (bigEndian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string binaryTriangle(bool big, float firstX = 0) {
  std::string bytes = fmt::format(
      "ply\nformat binary_{}_endian 1.0\nelement face 1\nproperty list ushort uint vertex_index\n"
      "element vertex 3\nproperty float x\nproperty double y\nproperty short z\n"
      "property half weight\nend_header\n",
      big ? "big" : "little");
  bytes += bytesOf<uint16_t>(3, big);
  for (uint32_t i = 0; i < 3; ++i) bytes += bytesOf(i, big);
  const float xs[] = {firstX, 1, 1};
  const double ys[] = {0, 0, 0.5};
  for (int i = 0; i < 3; ++i)
    bytes += bytesOf(xs[i], big) + bytesOf(ys[i], big) + bytesOf<int16_t>(-300, big) +
             bytesOf<uint16_t>(0x3e00, big);
  return bytes;
}

TEST_F(Ply, BinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const Mesh mesh = read(binaryTriangle(big));
    ASSERT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.positions[2], Vec3f(1, 0.5f, -300));
    EXPECT_EQ(mesh.triangles[0], Vec3u(0, 1, 2));
    EXPECT_EQ(attribute(mesh, "vertex_weight").values[0], 1.5f);
  }
}

TEST_F(Ply, EveryTruncationIsAnErrorAndNoCrash) {
  for (const std::string& whole :
       {binaryTriangle(false), binaryTriangle(true), kAscii.substr(0, kAscii.size() - 2)})
    for (size_t size = 0; size < whole.size(); ++size)
      EXPECT_THROW(read(whole.substr(0, size)), InputError) << size;
}

TEST_F(Ply, RandomDamageNeverCrashes) {
  std::mt19937 random(7);
  int refused = 0;
  for (int k = 0; k < 2000; ++k) {
    std::string bytes = k % 2 ? kAscii : binaryTriangle(k % 4 == 0);
    for (int n = 0; n < 3; ++n) bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      read(bytes);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 2000);
}

TEST_F(Ply, AbsurdCountsAreRefusedBeforeAllocating) {
  const auto with = [](const std::string& count) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
           "property list uint int vertex_indices\nend_header\n";
  };
  expectError(with("4000000000"), ":3", "promises 4000000000");
  expectError(with("18446744073709551615"), ":3", "promises");
  expectError(with("99999999999999999999999"), ":3", "not a count");
  expectError(with("-1"), ":3", "not a count");
  expectError(with("1") + std::string(12, '\0') + "\xff\xff\xff\x7f" + "abc", "",
              "longer than the rest");
}

TEST_F(Ply, ErrorsNameThePlace) {
  const auto broken = [](const std::string& what, const std::string& by) {
    std::string text = kAscii;
    text.replace(text.find(what), what.size(), by);
    return text;
  };
  expectError("", "", "not a PLY file");
  expectError("plyx\n", ":1", "not a PLY file");
  expectError(broken("ascii", "asci"), ":2", "did you mean 'ascii'");
  expectError(broken("double z", "duoble z"), ":7", "unknown PLY type 'duoble'");
  expectError(broken("property float y", "prperty float y"), ":6", "prperty");
  expectError(broken("float y", "float x"), ":6", "twice");
  expectError(broken("float x", "float q"), ":4", "no x, y and z");
  expectError(broken("vertex_indices", "corners"), ":16", "vertex_indices");
  expectError(broken("element face", "element plane"), "", "no element 'face'");
  expectError(broken("1 0 0 1 0 0", "1 nan 0 1 0 0"), ":25", "not finite");
  expectError(broken("1 0 0 1 0 0", "1 1e999 0 1 0 0"), ":25", "not finite");
  expectError(broken("1 0 0 1 0 0", "1 1e39 0 1 0 0"), ":25", "y is not finite");
  expectError(broken("1 0 0 1 0 0", "1 zero 0 1 0 0"), ":25", "'zero' is not a number");
  expectError(broken("4 0 1 2 3", "4 0 1 2 4"), "", "vertex 4");
  expectError(broken("4 0 1 2 3", "4 0 1 2 -1"), ":28", "-1 is not the index");
  expectError(binaryTriangle(false, std::nanf("")), "", "vertex 0");
}

TEST_F(Ply, FacesOfTwoCornersAreLeftOutWithAWarning) {
  std::string text = kAscii;
  const std::string face = "4 0 1 2 3 .1 .2 .3\n";
  text.replace(text.find("face 1"), 6, "face 2");
  text.insert(text.find(face), "2 0 1 0 0 0\n");
  EXPECT_EQ(read(text).triangles.size(), 2u);
  ASSERT_EQ(findings.size(), 1u);
}

TEST_F(Ply, WritingAndReadingGivesTheSameBits) {
  Mesh mesh = read(kAscii);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (Vec3f& n : mesh.normals)
    n = normalize(Vec3f(uniform(random), uniform(random), uniform(random)));
  mesh.attributes.push_back({"face_id", true, 1, {3, 4}});
  io::writePly(folder.path("copy.ply"), mesh);
  const Mesh copy = io::readPly(folder.path("copy.ply"), {}, {}, findings);
  EXPECT_EQ(copy.positions, mesh.positions);
  EXPECT_EQ(copy.normals, mesh.normals);
  EXPECT_EQ(copy.uvs, mesh.uvs);
  EXPECT_EQ(copy.triangles, mesh.triangles);
  ASSERT_EQ(copy.attributes.size(), mesh.attributes.size());
  for (const MeshAttribute& a : mesh.attributes) {
    const bool lone = a.name == "vertex_lone" || a.name == "face_id";
    EXPECT_EQ(attribute(copy, a.name).values, a.values) << a.name << lone;
    EXPECT_EQ(attribute(copy, a.name).size, a.size);
    EXPECT_EQ(attribute(copy, a.name).perFace, a.perFace);
  }
}

TEST_F(Ply, UnwritableFolderIsARuntimeError) {
  const Mesh mesh = read(kAscii);
  const std::string target = folder.path("gone/x.ply");
  EXPECT_TRUE(contains(messageOf<RuntimeError>([&] { io::writePly(target, mesh); }), target));
}

TEST_F(Ply, RealMeshes) {
  const std::string data = test::sharedFolder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  const Mesh dragon = io::readPly(data + "/data/meshes/dragon_vrip_res2.ply", {}, {}, findings);
  EXPECT_EQ(dragon.triangles.size(), 202520u);
  const Mesh bunny =
      io::readPly(data + "/references/mitsuba/common/meshes/bunny.ply", {}, {}, findings);
  EXPECT_EQ(bunny.positions.size(), 35947u);
  EXPECT_EQ(bunny.triangles.size(), 69451u);
}

}  // namespace
}  // namespace lobelia
