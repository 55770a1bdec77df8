// What fuzzing has found (fuzz/): inputs that must be refused, or read, without anything but an
// InputError.
#include "io/gltf_builder.h"
#include "io/pbrt_scene.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia {
namespace {

using test::GltfBuilder;

class Hostile : public test::GltfTest {};

TEST_F(Hostile, NamesWithAZeroByte) {
  const std::string obj = folder.write("a.obj", std::string("mtllib a.obj\0b\nv 0 0 0\nv 1 0 0\n"
                                                            "v 0 1 0\nf 1 2 3\n",
                                                            47));
  Context context;
  EXPECT_TRUE(warns(io::readBareMesh(obj, {}, context), "zero byte"));
  EXPECT_TRUE(contains(messageOf<InputError>([&] { io::readImage(std::string("a\0.png", 6), {}); }),
                       "zero byte"));
}

// A camera is put in front of scenes that have none, wherever they are.
TEST_F(Hostile, SizesThatNoCameraCanFrame) {
  const float kPlaces[][3] = {{3e38f, -3e38f, 3e38f}, {1e38f, 1e38f, 1e38f}, {1e-42f, 0, 0},
                              {1e8f, 1e8f, 1e8f},     {1e20f, 1, 1},         {0, 0, 0}};
  for (const auto& p : kPlaces) {
    SCOPED_TRACE(p[0]);
    GltfBuilder b;
    b.accessor<float>({p[0], p[1], p[2], p[0] * 0.999f, p[1], p[2], p[0], p[1] * 0.999f, 0}, "VEC3",
                      3);
    const Scene scene = read(b.json(
        R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"));
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& c = scene.cameras[0];
    EXPECT_TRUE(c.toWorld.to.isFinite() && c.toWorld.from.isFinite());
    EXPECT_TRUE(std::isfinite(c.nearClip) && std::isfinite(c.farClip));
    EXPECT_LT(c.nearClip, c.farClip);
  }
}

TEST_F(Hostile, DracoCountsThatTheDataCannotHold) {
  const auto file = [](const std::vector<uint8_t>& data) {
    GltfBuilder b;
    b.rawAccessor(R"("componentType":5126,"count":3,"type":"VEC3")");
    b.view(data);
    return b.json(R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
                  R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":)"
                  R"({"POSITION":0}}}}]}])");
  };
  const std::string path = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
  // Version 2.2, sequential (0) or edgebreaker (1), no flags, then counts of 2^32 - 1.
  const std::vector<uint8_t> start{'D', 'R', 'A', 'C', 'O', 2, 2, 1};
  for (const uint8_t method : {uint8_t{0}, uint8_t{1}}) {
    std::vector<uint8_t> data = start;
    data.insert(data.end(), {method, 0, 0});
    if (method == 1) data.push_back(0);
    data.insert(data.end(), {0xff, 0xff, 0xff, 0xff, 0x0f, 0xff, 0xff, 0xff, 0xff, 0x0f});
    expectError(file(data), path, "4294967295 faces");
    expectError(file({data.begin(), data.begin() + 11}), path, "damaged");
  }
}

TEST_F(Hostile, ImagesOfOtherFormats) {
  const std::string message =
      messageOf<InputError>([&] { io::readImage(folder.write("a.gif", "GIF89a and so on"), {}); });
  EXPECT_TRUE(contains(message, "a.gif: ")) << message;
  EXPECT_TRUE(contains(message, "EXR, HDR, PNG")) << message;
}

// Sizes that the libraries would allocate for.
TEST_F(Hostile, ImagesThatStateMoreThanThereIs) {
  const auto refusal = [&](const std::string& name, const std::string& bytes) {
    return messageOf<InputError>([&] { io::readImage(folder.write(name, bytes), {}); });
  };
  const std::string png = std::string("\x89PNG\r\n\x1a\n", 8) + std::string("\x4e\0\0\x77tEXt", 8) +
                          std::string(20, 'x');
  EXPECT_TRUE(contains(refusal("a.png", png), "1308622967 bytes, 16 are left"));
  // A progressive frame of 65535 x 65535, behind a comment and bytes that are no marker.
  const std::string jpeg = std::string("\xff\xd8\xff\xfe\0\x04zzxx", 10) +
                           std::string("\xff\xc2\0\x11\x08\xff\xff\xff\xff\x03", 10) +
                           std::string(9, '\1');
  EXPECT_TRUE(contains(refusal("a.jpg", jpeg), "65535 x 65535 pixels with 3"));
  std::string bmp(54, '\0');
  bmp.replace(0, 2, "BM"), bmp[14] = 40;
  bmp.replace(18, 8, std::string("\0\0\1\0\0\0\xff\xff", 8));  // 65536 x -65536
  EXPECT_TRUE(contains(refusal("a.bmp", bmp), "65536 x 65536 pixels"));
}

TEST_F(Hostile, PbrtTransformsThatMultiplyToNothing) {
  const std::string scales = "Scale 1e-200 1 1 Scale 1e-200 1 1";
  EXPECT_TRUE(contains(test::pbrtRefusal(scales), "without an inverse"));
  EXPECT_TRUE(contains(test::pbrtRefusal("Shape \"loopsubdiv\" \"integer levels\" 10 \"point3 P\" "
                                         "[0 0 0 1 0 0 0 1 0 0 0 1 1 1 1] \"integer indices\" "
                                         "[0 1 2 0 2 3 0 3 1 1 3 2 1 2 4]"),
                       "at most"));
}

}  // namespace
}  // namespace lobelia
