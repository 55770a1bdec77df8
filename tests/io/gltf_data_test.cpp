// Containers, accessors, compression: glTF's data as meshes.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/metadata/geometry_metadata.h>
#include <meshoptimizer.h>

#include <limits>

#include "io/gltf_builder.h"
#include "support/data.h"

namespace lobelia {
namespace {

using test::GltfBuilder;
using test::kOneNode;

class GltfData : public test::GltfTest {};

TEST_F(GltfData, SquareFromDataUriBinaryAndFile) {
  const GltfBuilder b = GltfBuilder::square();
  const std::string scene = kOneNode + GltfBuilder::squareMesh();
  std::string beside = b.json(scene, false);
  beside.insert(beside.find(R"("byteLength":)" + std::to_string(b.bytes().size())),
                R"("uri":"my%20data.bin",)");
  folder.write("my data.bin", b.bytes());
  for (const std::string& text : {b.json(scene), b.glb(scene), beside}) {
    const Scene s = read(text);
    ASSERT_EQ(s.meshes.size(), 1u);
    EXPECT_EQ(s.meshes[0].positions[2], Vec3f(1, 1, 0));
    EXPECT_EQ(s.meshes[0].normals[2], Vec3f(0, 0, 1));
    EXPECT_EQ(s.meshes[0].uvs[0], Vec2f(0, 1));
    EXPECT_EQ(s.meshes[0].triangles[1], Vec3u(0, 2, 3));
    EXPECT_EQ(s.name, "a");
    for (const Finding& f : s.findings) EXPECT_NE(f.severity, Severity::warning) << f.message;
  }
}

TEST_F(GltfData, DamagedBinaryFiles) {
  const std::string good = GltfBuilder::square().glb(kOneNode + GltfBuilder::squareMesh());
  for (const size_t size : {4u, 11u, 19u, 30u, 200u})
    EXPECT_TRUE(contains(messageOf<InputError>([&] { read(good.substr(0, size)); }), "a.glb: "));
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { read(good.substr(0, good.size() - 4)); }), "truncated"));
  std::string version = good;
  version[4] = 1;
  EXPECT_TRUE(contains(messageOf<InputError>([&] { read(version); }), "version 1"));
  std::string chunk = good;
  chunk.replace(12, 4, GltfBuilder::word(0x7fffffff));
  EXPECT_TRUE(contains(messageOf<InputError>([&] { read(chunk); }), "chunk"));
  std::string type = good;
  type.replace(16, 4, "XXXX");
  EXPECT_TRUE(contains(messageOf<InputError>([&] { read(type); }), "must be JSON"));
  EXPECT_TRUE(contains(messageOf<InputError>([&] { read("{\"asset\":"); }), "not valid JSON"));
  EXPECT_TRUE(contains(messageOf<InputError>([&] { read("[]"); }), "object"));
}

TEST_F(GltfData, BadBuffersAndViews) {
  const GltfBuilder b = GltfBuilder::square();
  const std::string scene = kOneNode + GltfBuilder::squareMesh();
  const std::string good = b.json(scene);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
  };
  expectError(with(R"("buffers":[{"byteLength":)", R"("buffers":[{"byteLength":9)"),
              "buffers[0].byteLength", "truncated");
  expectError(with("base64,", "base64,*"), "buffers[0].uri", "damaged");
  expectError(with("data:", "https:"), "buffers[0].uri", "only files beside");
  expectError(with("data:application/octet-stream;base64,", "no/such/file/"), "buffers[0].uri",
              "there is no file");
  expectError(with(R"("byteOffset":0,"byteLength":48)", R"("byteOffset":999,"byteLength":48)"),
              "bufferViews[0]", "its buffer has");
  expectError(with(R"("byteOffset":0,"byteLength":48)", R"("byteOffset":0,"byteLength":-1)"),
              "bufferViews[0].byteLength", "0 or more");
  expectError(with(R"("byteOffset":0,"byteLength":48)", R"("byteLength":48,"byteStride":8)"),
              "accessors[0].bufferView", "byteStride is 8");
  expectError(with(R"("count":4)", R"("count":400000000)"), "accessors[0]", "need more than");
  expectError(with(R"("count":4)", R"("count":1e300)"), "accessors[0].count", "too large");
  expectError(with(R"("count":4)", R"("count":"4")"), "accessors[0].count", "number");
  expectError(with(R"("type":"VEC3")", R"("type":"VEC9")"),
              "meshes[0].primitives[0].attributes.POSITION", "VEC9");
  expectError(with(R"("componentType":5126)", R"("componentType":5124)"),
              "accessors[0].componentType", "5124");
  expectError(with(R"("POSITION":0)", R"("POSITION":17)"),
              "meshes[0].primitives[0].attributes.POSITION", "17 is out of range");
  expectError(with(R"("POSITION":0)", R"("POSITION":2)"),
              "meshes[0].primitives[0].attributes.POSITION", "VEC3");
}

TEST_F(GltfData, IndicesAndNumbersAreChecked) {
  GltfBuilder b = GltfBuilder::square();
  const size_t bad = b.accessor<uint16_t>({0, 1, 65535}, "SCALAR", 1);
  const size_t nan = b.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, std::nanf(""), 0, 1, 0}, "VEC3", 3);
  const auto mesh = [](size_t position, size_t indices) {
    return kOneNode + fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}},)"
                                  R"("indices":{}}}]}}])",
                                  position, indices);
  };
  expectError(b.json(mesh(0, bad)), "meshes[0].primitives[0].indices", "index 2 is 65535");
  expectError(b.json(mesh(nan, 3)), fmt::format("accessors[{}]", nan), "not finite");
  expectError(b.json(mesh(0, 0)), "meshes[0].primitives[0].indices", "SCALAR");
  const Scene flat = read(b.json(mesh(0, 3)));
  EXPECT_TRUE(flat.meshes[0].normals.empty());
}

TEST_F(GltfData, QuantizedNormalizedAndStrided) {
  GltfBuilder b;
  // 16-bit positions with a stride of 8, normalised 8-bit normals with a stride of 4.
  const size_t positions =
      b.view<int16_t>({0, 0, 0, 99, 10, 0, 0, 99, 0, -20, 0, 99}, R"("byteStride":8)");
  b.rawAccessor(
      fmt::format(R"("bufferView":{},"componentType":5122,"count":3,"type":"VEC3")", positions));
  const size_t normals =
      b.view<int8_t>({0, 0, -128, 9, 0, 0, -127, 9, 0, 0, -127, 9}, R"("byteStride":4)");
  b.rawAccessor(fmt::format(
      R"("bufferView":{},"componentType":5120,"normalized":true,"count":3,"type":"VEC3")",
      normals));
  b.accessor<uint16_t>({0, 0, 65535, 0, 0, 65535}, "VEC2", 2, R"("normalized":true)");
  const Scene s = read(b.json(
      kOneNode +
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}]}],)"
      R"("extensionsRequired":["KHR_mesh_quantization"])"));
  EXPECT_EQ(s.meshes[0].positions[2], Vec3f(0, -20, 0));
  EXPECT_EQ(s.meshes[0].normals[0], Vec3f(0, 0, -1));
  EXPECT_EQ(s.meshes[0].uvs[1], Vec2f(1, 0));
  EXPECT_EQ(s.meshes[0].triangles, (std::vector<Vec3u>{{0, 1, 2}}));
}

TEST_F(GltfData, SparseWithAndWithoutBase) {
  GltfBuilder b = GltfBuilder::square();
  const size_t index = b.view<uint8_t>({1, 2}), value = b.view<float>({5, 6, 7, 8, 9, 10});
  const auto sparse = [&](const std::string& base, int count) {
    return b.rawAccessor(
        fmt::format(R"({}"componentType":5126,"count":4,"type":"VEC3","sparse":{{"count":{},)"
                    R"("indices":{{"bufferView":{},"componentType":5121}},)"
                    R"("values":{{"bufferView":{}}}}})",
                    base, count, index, value));
  };
  const auto mesh = [](size_t position) {
    return kOneNode + fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}},)"
                                  R"("indices":3}}]}}])",
                                  position);
  };
  const size_t over = sparse(R"("bufferView":0,)", 2), zeros = sparse("", 2), many = sparse("", 3);
  const std::vector<Vec3f> first = read(b.json(mesh(over))).meshes[0].positions;
  EXPECT_EQ(first, (std::vector<Vec3f>{{0, 0, 0}, {5, 6, 7}, {8, 9, 10}, {0, 1, 0}}));
  const std::vector<Vec3f> second = read(b.json(mesh(zeros))).meshes[0].positions;
  EXPECT_EQ(second, (std::vector<Vec3f>{{}, {5, 6, 7}, {8, 9, 10}, {}}));
  expectError(b.json(mesh(many)), fmt::format("accessors[{}].sparse.indices", many),
              "need more than");
  const size_t huge = b.rawAccessor(R"("componentType":5126,"count":4000000000,"type":"VEC3")");
  expectError(b.json(mesh(huge)), fmt::format("accessors[{}].count", huge), "without a bufferView");
}

TEST_F(GltfData, StripsFansPointsAndLines) {
  GltfBuilder b = GltfBuilder::square();
  b.accessor<uint8_t>({0, 1, 3, 2, 2}, "SCALAR", 1);  // accessor 4
  const auto mesh = [](int mode, int indices) {
    return kOneNode + fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},)"
                                  R"("indices":{},"mode":{}}}]}}])",
                                  indices, mode);
  };
  EXPECT_EQ(read(b.json(mesh(5, 4))).meshes[0].triangles,
            (std::vector<Vec3u>{{0, 1, 3}, {1, 2, 3}}));  // the stitch is gone
  EXPECT_EQ(read(b.json(mesh(6, 4))).meshes[0].triangles,
            (std::vector<Vec3u>{{1, 3, 0}, {3, 2, 0}}));
  for (const int mode : {0, 1, 2, 3}) {
    const Scene s = read(b.json(mesh(mode, 3)));
    EXPECT_TRUE(s.instances.empty());
    EXPECT_TRUE(warns(s, "meshes[0].primitives[0].mode"));
  }
  expectError(b.json(mesh(7, 3)), "meshes[0].primitives[0].mode", "0 to 6");
}

TEST_F(GltfData, MeshoptViews) {
  GltfBuilder b;
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12));
  vertices.resize(
      meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), 4, 12));
  const std::vector<unsigned> corners{0, 1, 2, 2, 1, 3};
  std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(6, 4));
  triangles.resize(
      meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), corners.data(), 6));
  const auto compressed = [&](const std::vector<unsigned char>& data, const std::string& mode,
                              int stride, int count) {
    const size_t offset = (b.bytesBefore() + 3) / 4 * 4;
    return b.view(data, fmt::format(R"("extensions":{{"EXT_meshopt_compression":{{"buffer":0,)"
                                    R"("byteOffset":{},"byteLength":{},"byteStride":{},)"
                                    R"("mode":"{}","count":{}}}}})",
                                    offset, data.size(), stride, mode, count));
  };
  const size_t p = compressed(vertices, "ATTRIBUTES", 12, 4);
  const size_t i = compressed(triangles, "TRIANGLES", 2, 6);
  const size_t huge = compressed(vertices, "ATTRIBUTES", 12, 2000000000);
  const size_t damaged = compressed({1, 2, 3, 4}, "TRIANGLES", 2, 6);
  for (const size_t view : {p, huge})
    b.rawAccessor(
        fmt::format(R"("bufferView":{},"componentType":5126,"count":4,"type":"VEC3")", view));
  for (const size_t view : {i, damaged})
    b.rawAccessor(
        fmt::format(R"("bufferView":{},"componentType":5123,"count":6,"type":"SCALAR")", view));
  const auto mesh = [](int position, int indices) {
    return kOneNode + fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}},)"
                                  R"("indices":{}}}]}}])",
                                  position, indices);
  };
  const Scene s = read(b.json(mesh(0, 2)));
  EXPECT_EQ(s.meshes[0].positions[2], Vec3f(1, 1, 0));
  EXPECT_EQ(s.meshes[0].triangles.size(), 2u);
  expectError(b.json(mesh(1, 2)),
              fmt::format("bufferViews[{}].extensions.EXT_meshopt_compression.count", huge),
              "cannot hold");
  expectError(b.json(mesh(0, 3)),
              fmt::format("bufferViews[{}].extensions.EXT_meshopt_compression", damaged),
              "damaged");
}

TEST_F(GltfData, DracoPrimitive) {
  draco::TriangleSoupMeshBuilder soup;
  soup.Start(1);
  const int id = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const float a[3] = {0, 0, 0}, b1[3] = {1, 0, 0}, c[3] = {0, 2, 0};
  soup.SetAttributeValuesForFace(id, draco::FaceIndex(0), a, b1, c);
  const std::unique_ptr<draco::Mesh> mesh = soup.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  GltfBuilder b;
  const std::vector<char> bytes(buffer.data(), buffer.data() + buffer.size());
  const size_t good = b.view(bytes);
  const size_t cut = b.view(std::vector<char>(bytes.begin(), bytes.begin() + 12));
  b.rawAccessor(R"("componentType":5126,"count":3,"type":"VEC3")");
  const auto text = [&](size_t view, const std::string& attribute) {
    return b.json(kOneNode +
                  fmt::format(R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},)"
                              R"("extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{},)"
                              R"("attributes":{{"POSITION":{}}}}}}}}}]}}],)"
                              R"("extensionsRequired":["KHR_draco_mesh_compression"])",
                              view, attribute));
  };
  const Scene s = read(text(good, "0"));
  ASSERT_EQ(s.meshes[0].triangles.size(), 1u);
  Bounds3f box;
  for (const Vec3f p : s.meshes[0].positions) box.add(p);
  EXPECT_NEAR(box.hi.x, 1, 1e-5);
  EXPECT_NEAR(box.hi.y, 2, 1e-5);
  const std::string path = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
  expectError(text(cut, "0"), path, "damaged");
  expectError(text(good, "7"), path + ".attributes.POSITION", "no attribute 7");
}

// Faces, not a strip's corners, come out of Draco data; metadata stand before their counts.
TEST_F(GltfData, DracoStripsAndMetadata) {
  draco::TriangleSoupMeshBuilder soup;
  soup.Start(2);
  const int id = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const float a[3] = {0, 0, 0}, b1[3] = {1, 0, 0}, c[3] = {0, 2, 0}, d[3] = {1, 2, 0};
  soup.SetAttributeValuesForFace(id, draco::FaceIndex(0), a, b1, c);
  soup.SetAttributeValuesForFace(id, draco::FaceIndex(1), c, b1, d);
  const std::unique_ptr<draco::Mesh> mesh = soup.Finalize();
  const auto encoded = [&](draco::Encoder encoder) {
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return std::vector<char>(buffer.data(), buffer.data() + buffer.size());
  };
  const auto text = [&](const std::vector<char>& bytes) {
    GltfBuilder b;
    const size_t view = b.view(bytes);
    b.rawAccessor(R"("componentType":5126,"count":4,"type":"VEC3")");
    return b.json(
        kOneNode +
        fmt::format(R"("meshes":[{{"primitives":[{{"mode":5,"attributes":{{"POSITION":0}},)"
                    R"("extensions":{{"KHR_draco_mesh_compression":{{"bufferView":{},)"
                    R"("attributes":{{"POSITION":0}}}}}}}}]}}],)"
                    R"("extensionsRequired":["KHR_draco_mesh_compression"])",
                    view));
  };
  EXPECT_EQ(read(text(encoded({}))).meshes[0].triangles.size(), 2u);

  auto metadata = std::make_unique<draco::GeometryMetadata>();
  metadata->AddEntryString("made by", std::string(200, 'x'));
  auto below = std::make_unique<draco::Metadata>();
  below->AddEntryInt("number", 7);
  metadata->AddSubMetadata("below", std::move(below));
  auto ofPositions = std::make_unique<draco::AttributeMetadata>();
  ofPositions->set_att_unique_id(0);
  ofPositions->AddEntryString("name", "positions");
  metadata->AddAttributeMetadata(std::move(ofPositions));
  mesh->AddMetadata(std::move(metadata));
  for (const int speed : {0, 10}) {  // edgebreaker, sequential
    draco::Encoder encoder;
    encoder.SetSpeedOptions(speed, speed);
    const std::vector<char> bytes = encoded(encoder);
    EXPECT_EQ(read(text(bytes)).meshes[0].triangles.size(), 2u) << speed;
    const std::string path = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
    for (const size_t size : {13u, 20u, 60u, 250u})
      expectError(text({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), path,
                  "damaged");
    // The counts follow the metadata; "number" is the last of their names.
    const std::string all(bytes.begin(), bytes.end());
    size_t at = all.find("number");
    ASSERT_NE(at, all.npos);
    at += 6 + 1 + 4 + 1 + (speed == 0 ? 1 : 0);  // name, size, value, no more below; connectivity
    std::string huge = all;
    huge.replace(at, 1, "\xff\xff\xff\xff\x07");
    expectError(text({huge.begin(), huge.end()}), path, "cannot hold that many");
  }
}

TEST_F(GltfData, RealFilesHaveTheTrianglesThatAreKnown) {
  const std::string data = test::sharedFolder() + "/data/";
  if (!std::filesystem::is_directory(data + "scenes/gltf")) GTEST_SKIP() << "no shared data";
  const std::pair<std::string, uint64_t> files[] = {
      {"scenes/gltf/chess-board/chess-board.glb", 178848},
      {"scenes/gltf/kitchen/scene.gltf", 70568},
      {"scenes/gltf/bedroom/scene.gltf", 6460},
      {"scenes/gltf/AnisotropyStrengthTest/AnisotropyStrengthTest.glb", 97240},
      {"scenes/gltf/ClearCoatTest/ClearCoatTest.glb", 37116},
      {"scenes/gltf/SpecularTest/SpecularTest.glb", 44828},
      {"scenes/gltf/TransmissionRoughnessTest/TransmissionRoughnessTest.glb", 77792},
      {"scenes/gltf/CornellBox/CornellBox.glb", 38},  // 36, and the back of the lamp
      {"scenes/gltf/FlightHelmet/FlightHelmet.gltf", 94722},
      {"meshes/suzanne.obj", 968},
      {"meshes/utah-teapot.obj", 25200}};
  for (const auto& [file, triangles] : files) {
    if (!std::filesystem::exists(data + file)) continue;
    Context context;
    const Scene scene = io::readScene(data + file, {}, context);
    EXPECT_EQ(triangleCount(scene), triangles) << file;
    EXPECT_EQ(scene.cameras.size(), 1u) << file;
    EXPECT_FALSE(scene.emitters.empty()) << file;
    for (const Finding& f : scene.findings)
      EXPECT_EQ(f.severity, Severity::info) << file << ": " << f.message;
    for (const Finding& f : validate(scene))
      EXPECT_NE(f.severity, Severity::error) << file << ": " << f.message;
  }
}

}  // namespace
}  // namespace lobelia
