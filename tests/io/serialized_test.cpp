#include <zlib.h>

#include <cstring>
#include <random>

#include "io/temporary_folder.h"
#include "lobelia/io/mesh_io.h"
#include "support/data.h"

namespace lobelia {
namespace {

class Bytes {
 public:
  template <class T>
  Bytes& operator<<(T value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  std::string text;
};

std::string deflated(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
           text.size());
  out.resize(size);
  return out;
}

// One triangle whose first vertex is at x.
template <class Real>
std::string meshBytes(uint16_t version, uint32_t flags, Real x, uint64_t vertexCount = 3) {
  Bytes head, body;
  head << uint16_t{0x041c} << version;
  body << flags;
  if (version == 4) body.text += std::string("tri\0", 4);
  body << vertexCount << uint64_t{1};
  for (const Real v : {x, Real(0), Real(0), Real(1), Real(0), Real(0), Real(1), Real(1), Real(0)})
    body << v;
  if (flags & 1)
    for (int i = 0; i < 3; ++i) body << Real(1) << Real(0) << Real(0);
  if (flags & 2)
    for (int i = 0; i < 3; ++i) body << Real(0.5) << Real(0.25);
  if (flags & 8)
    for (int i = 0; i < 9; ++i) body << Real(i);
  body << uint32_t{0} << uint32_t{1} << uint32_t{2};
  return head.text + deflated(body.text);
}

class Serialized : public testing::Test {
 protected:
  Mesh read(const std::string& bytes, int index = 0) {
    findings.clear();
    io::MeshOptions options;
    options.shapeIndex = index;
    return io::readSerialized(folder.write("mesh.serialized", bytes), options, {}, findings);
  }
  void expectError(const std::string& bytes, int index, const std::string& part) {
    const std::string message = messageOf<InputError>([&] { read(bytes, index); });
    EXPECT_TRUE(contains(message, "mesh.serialized: ")) << message;
    EXPECT_TRUE(contains(message, part)) << message;
  }
  TemporaryFolder folder;
  std::vector<Finding> findings;
};

TEST_F(Serialized, SingleAndDoublePrecisionOfBothVersions) {
  for (const uint16_t version : {uint16_t{3}, uint16_t{4}}) {
    const Mesh a = read(meshBytes<float>(version, 0x1000, 0.25f));
    EXPECT_EQ(a.positions[0], Vec3f(0.25f, 0, 0));
    EXPECT_EQ(a.normals[0], Vec3f(0, 0, 1));  // computed
    EXPECT_EQ(a.name, version == 4 ? "tri" : "mesh");
    const Mesh b = read(meshBytes<double>(version, 0x2000 | 1 | 2 | 8, 0.25));
    EXPECT_EQ(b.positions[0], Vec3f(0.25f, 0, 0));
    EXPECT_EQ(b.normals[0], Vec3f(1, 0, 0));
    EXPECT_EQ(b.uvs[2], Vec2f(0.5f, 0.25f));
    ASSERT_EQ(b.attributes.size(), 1u);
    EXPECT_EQ(b.attributes[0].values[8], 8);
  }
}

TEST_F(Serialized, FaceNormalsFlag) {
  EXPECT_TRUE(read(meshBytes<float>(4, 0x1000 | 1 | 0x10, 0)).normals.empty());
}

std::string twoShapes(uint16_t version) {
  const std::string a = meshBytes<float>(version, 0x1000, 5),
                    b = meshBytes<float>(version, 0x1000, 7);
  Bytes end;
  if (version == 4)
    end << uint64_t{0} << uint64_t{a.size()};
  else
    end << uint32_t{0} << static_cast<uint32_t>(a.size());
  end << uint32_t{2};
  return a + b + end.text;
}

TEST_F(Serialized, ShapeIndexLooksUpTheDictionary) {
  for (const uint16_t version : {uint16_t{3}, uint16_t{4}}) {
    EXPECT_EQ(read(twoShapes(version), 0).positions[0].x, 5);
    EXPECT_EQ(read(twoShapes(version), 1).positions[0].x, 7);
    expectError(twoShapes(version), 2, "there is no shape 2; the file has 2");
    expectError(twoShapes(version), -1, "negative");
    std::string damaged = twoShapes(version);
    damaged.back() = '\x7f';
    expectError(damaged, 1, "dictionary");
  }
}

TEST_F(Serialized, DamagedFilesAreErrors) {
  const std::string whole = meshBytes<float>(4, 0x1000 | 1 | 2, 0);
  // The last 5 bytes are the end of the deflate stream and its checksum.
  for (size_t size = 0; size + 5 < whole.size(); ++size)
    EXPECT_THROW(read(whole.substr(0, size)), InputError) << size;
  expectError("\x1c\x05" + whole.substr(2), 0, "not a serialized mesh");
  expectError(std::string("\x1c\x04\x09\x00", 4) + whole.substr(4), 0, "version 9");
  expectError(meshBytes<float>(4, 0x1000, std::nanf("")), 0, "position of vertex 0");
  expectError(meshBytes<float>(4, 0x1000, 0, 4000000000u), 0, "more than a file");
  expectError(meshBytes<float>(4, 0x1000, 0, ~uint64_t{0}), 0, "more than a file");
  expectError(meshBytes<float>(4, 0x1000, 0, 2), 0, "");
  std::mt19937 random(3);
  for (int k = 0; k < 2000; ++k) {
    std::string bytes = twoShapes(4);
    for (int n = 0; n < 3; ++n) bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      read(bytes, k % 2);
    } catch (const InputError&) {
    }
  }
}

TEST_F(Serialized, RealFile) {
  const std::string data = test::sharedFolder();
  if (data.empty()) GTEST_SKIP() << "no data folder";
  const std::string file = data + "/references/mitsuba/common/meshes/matpreview.serialized";
  for (int i = 0; i < 3; ++i) {
    io::MeshOptions options;
    options.shapeIndex = i;
    const Mesh mesh = io::readSerialized(file, options, {}, findings);
    EXPECT_GT(mesh.triangles.size(), 0u);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  }
}

}  // namespace
}  // namespace lobelia
