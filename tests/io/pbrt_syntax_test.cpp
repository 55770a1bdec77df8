// PBRT files: words, parameters, includes, directives in the right places, transformations.
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/pbrt_scene.h"

namespace lobelia::test {
namespace {

constexpr const char* kSphere = "Shape \"sphere\"\n";

std::string gzip(const std::string& text) {
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(text.size() + 1000, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  z.avail_in = static_cast<uInt>(text.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

Vec3f centreOf(const Scene& scene, size_t i = 0) {
  return scene.instances.at(i).toWorld.point({0, 0, 0});
}

void expectAt(Vec3f a, Vec3f b) {
  EXPECT_NEAR(a.x, b.x, 1e-5f);
  EXPECT_NEAR(a.y, b.y, 1e-5f);
  EXPECT_NEAR(a.z, b.z, 1e-5f);
}

TEST(PbrtSyntax, RefusesBadTexts) {
  const std::pair<const char*, const char*> cases[] = {
      {"Shape \"sphere", "the string does not end"},
      {"Shape \"sphe\\qre\"", "escape"},
      {"Shap \"sphere\"", "unknown directive 'Shap'; did you mean 'Shape'?"},
      {"Shape \"spere\"", "unknown shape 'spere'; did you mean 'sphere'?"},
      {"\"sphere\"", "a directive was expected"},
      {"Shape \"sphere\" \"float radius\" [ 1 2 ]", "has 2 values; it takes 1"},
      {"Shape \"sphere\" \"float radius\" \"1\"", "it takes numbers"},
      {"Shape \"sphere\" \"float radius\" nan", "not"},
      {"Shape \"sphere\" \"float radius\" 1e999", "finite"},
      {"Shape \"sphere\" \"float radius\" 1.5x", "not a number"},
      {"Shape \"sphere\" \"float radius\" [ 1", "']' is missing"},
      {"Shape \"sphere\" \"float radius\"", "has no value"},
      {"Shape \"sphere\" \"float radius\" [ [ 1 ] ]", "within brackets"},
      {"Shape \"sphere\" \"string radius\" \"1\"", "should be of type float"},
      {"Shape \"sphere\" \"flaot radius\" 1", "did you mean 'float'?"},
      {"Shape \"sphere\" \"radius\" 1", "should be \"type name\""},
      {"Shape \"sphere\" \"float radius\" 1 \"float radius\" 2", "given twice"},
      {"Shape \"sphere\" \"float radius\" -1", "must be above 0"},
      {"Shape \"sphere\" \"bool remaproughness\" maybe", "true or false"},
      {"AttributeEnd", "AttributeEnd without a AttributeBegin"},
      {"AttributeBegin", "has no AttributeEnd"},
      {"AttributeBegin TransformBegin AttributeEnd", "TransformEnd was expected"},
      {"Translate 1 2", "takes 3 numbers"},
      {"Scale 1 0 1", "without an inverse"},
      {"Rotate 10 0 0 0", "without an inverse"},
      {"LookAt 0 0 0 0 0 0 0 1 0", "LookAt"},
      {"Camera \"perspective\"", "in front of WorldBegin"},
      {"Include \"missing.pbrt\"", "there is no scene file 'missing.pbrt'"},
      {"Include \"scene.pbrt\"", "includes itself"},
      {"ObjectInstance \"tree\"", "unknown object 'tree'"},
      {"ObjectBegin \"a\" ObjectBegin \"b\"", "within another"},
      {"ColorSpace \"srbg\"", "did you mean 'srgb'?"},
      {"Attribute \"shap\" \"float radius\" 2", "did you mean 'shape'?"},
      {"ActiveTransform Never", "StartTime"},
  };
  for (const auto& [text, message] : cases)
    EXPECT_TRUE(contains(pbrtRefusal(text), message)) << text << "\n" << pbrtRefusal(text);
}

TEST(PbrtSyntax, SaysWhere) {
  EXPECT_TRUE(contains(pbrtRefusal("# a comment\n  Shap \"sphere\""), "scene.pbrt:4:3:"));
  const Scene scene = readPbrtWorld("Shape \"sphere\"\n  \"float radus\" 2");
  ASSERT_EQ(scene.findings.size(), 1u);
  EXPECT_EQ(scene.findings[0].where.line, 4);
  EXPECT_TRUE(contains(scene.findings[0].message, "did you mean 'radius'?"));
  EXPECT_TRUE(contains(messageOf<InputError>([] {
                         io::ReadSettings settings;
                         settings.strict = true;
                         readPbrtWorld("Shape \"sphere\" \"float radus\" 2", settings);
                       }),
                       "--strict"));
}

TEST(PbrtSyntax, NeedsAWorld) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      contains(messageOf<InputError>([&] { readPbrtText(folder, "Identity"); }), "no WorldBegin"));
  EXPECT_TRUE(contains(messageOf<InputError>([&] { readPbrtText(folder, "Shape \"sphere\""); }),
                       "belongs behind WorldBegin"));
}

TEST(PbrtSyntax, ReadsIncludesImportsAndPackedFiles) {
  const TemporaryFolder folder;
  folder.write("part.pbrt", "Translate 1 0 0\nShape \"sphere\"\n");
  folder.write("packed.pbrt.gz", gzip("Translate 0 1 0\nShape \"sphere\"\n"));
  const std::string text =
      "WorldBegin Import \"part.pbrt\" Include \"part.pbrt\"\n"
      "Include \"packed.pbrt.gz\"";
  const Scene scene = readPbrtText(folder, text);
  ASSERT_EQ(scene.instances.size(), 3u);
  expectAt(centreOf(scene, 0), {1, 0, 0});
  expectAt(centreOf(scene, 1), {1, 0, 0});  // an import keeps its transformation to itself
  expectAt(centreOf(scene, 2), {1, 1, 0});
  Context context;
  const Scene packed = io::readScene(folder.write("all.pbrt.gz", gzip(text)), {}, context);
  EXPECT_EQ(packed.instances.size(), 3u);
  const std::string cut = gzip(text).substr(0, 40);
  EXPECT_TRUE(contains(
      messageOf<InputError>([&] { io::readScene(folder.write("cut.pbrt.gz", cut), {}, context); }),
      "truncated"));
}

TEST(PbrtSyntax, Transformations) {
  const auto at = [](const std::string& text) { return centreOf(readPbrtWorld(text + kSphere)); };
  expectAt(at("Translate 1 2 3 Scale 2 2 2 Translate 1 0 0 "), {3, 2, 3});
  expectAt(at("Translate 5 5 5 Identity "), {0, 0, 0});
  expectAt(at("Rotate 90 0 0 1 Translate 1 0 0 "), {0, 1, 0});
  expectAt(at("Transform [1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1] "), {7, 8, 9});
  expectAt(at("Translate 1 0 0 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1] "), {8, 8, 9});
  expectAt(at("Translate 1 0 0 CoordinateSystem \"here\" Identity CoordSysTransform \"here\" "),
           {1, 0, 0});
  expectAt(at("AttributeBegin Translate 1 0 0 AttributeEnd "), {0, 0, 0});
  expectAt(at("TransformBegin Translate 1 0 0 TransformEnd "), {0, 0, 0});
  expectAt(at("ActiveTransform EndTime Translate 1 0 0 ActiveTransform All "), {0, 0, 0});
  // LookAt gives camera coordinates: its inverse takes the origin to the eye.
  const Scene scene = readPbrtWorld(std::string("LookAt 1 2 3  1 2 9  0 1 0 ") + kSphere);
  expectAt(scene.instances[0].toWorld.from.point({0, 0, 0}), {1, 2, 3});
  expectAt(scene.instances[0].toWorld.point({2, 2, 3}), {1, 0, 0});  // x to the right
  EXPECT_TRUE(contains(findingsOf(readPbrtWorld("TransformTimes 0 1")), "motion"));
}

TEST(PbrtSyntax, ObjectsAndAttributes) {
  const Scene scene = readPbrtWorld(
      "Attribute \"shape\" \"float radius\" 2\n"
      "ObjectBegin \"ball\" Translate 1 0 0 Shape \"sphere\" ObjectEnd\n"
      "Translate 0 5 0 ObjectInstance \"ball\" Translate 0 5 0 ObjectInstance \"ball\"\n"
      "ReverseOrientation Shape \"sphere\" \"float radius\" 3\n"
      "Option \"bool disablepixeljitter\" true ReverseOrientation Shape \"sphere\"");
  ASSERT_EQ(scene.instances.size(), 4u);
  expectAt(centreOf(scene, 0), {1, 5, 0});
  expectAt(centreOf(scene, 1), {1, 10, 0});
  EXPECT_NEAR(scene.instances[0].toWorld.vector({1, 0, 0}).x, 2, 1e-6);
  EXPECT_NEAR(scene.instances[2].toWorld.vector({1, 0, 0}).x, 3, 1e-6);
  EXPECT_TRUE(scene.instances[2].flipNormals);
  EXPECT_FALSE(scene.instances[3].flipNormals);
  EXPECT_EQ(scene.meshes.size(), 1u);
}

Scene readOptions(const std::string& options) {
  const TemporaryFolder folder;
  return readPbrtText(folder, options + "\nWorldBegin\n");
}

TEST(PbrtSyntax, Cameras) {
  const Scene scene = readOptions(
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60 \"float lensradius\" "
      "0.1 "
      "\"float focaldistance\" 4\nFilm \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" "
      "200 \"float cropwindow\" [0 .5 .25 1]\nSampler \"halton\" \"integer pixelsamples\" 9\n"
      "Integrator \"path\" \"integer maxdepth\" 3\nPixelFilter \"triangle\" \"float xradius\" 1 "
      "\"float yradius\" 1");
  const Camera& c = scene.cameras.at(0);
  EXPECT_TRUE(scene.findings.empty()) << findingsOf(scene);
  // 60 degrees over the height.
  EXPECT_NEAR(std::tan(c.fovX / 2), 2 * std::tan(kPi / 6), 1e-5f);
  EXPECT_EQ(c.width, 400);
  EXPECT_EQ(c.cropX1, 200);
  EXPECT_EQ(c.cropY0, 50);
  EXPECT_EQ(c.spp, 9);
  EXPECT_EQ(scene.maxDepth, 4);
  EXPECT_EQ(c.filter, PixelFilter::tent);
  EXPECT_FLOAT_EQ(c.apertureRadius, 0.1f);
  EXPECT_FLOAT_EQ(c.focusDistance, 4);
  // PBRT's world is left-handed: the right of the picture is -x when looking along -z.
  const Ray right = generateRay(c, {399, 100}, {0.5f, 0.5f});
  EXPECT_LT(right.d.x, -0.5f);
  EXPECT_LT(right.d.z, 0);
  EXPECT_GT(generateRay(c, {200, 0}, {0.5f, 0.5f}).d.y, 0.3f);
}

TEST(PbrtSyntax, ScreenWindowsAndOrthographicCameras) {
  const std::string film = "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n";
  const Camera shifted = readOptions(film +
                                     "Camera \"perspective\" \"float fov\" 90 "
                                     "\"float screenwindow\" [0 1 0 1]")
                             .cameras.at(0);
  // The lower left corner looks straight ahead.
  expectAt(generateRay(shifted, {0, 100}, {}).d, {0, 0, 1});
  expectAt(generateRay(shifted, {100, 0}, {}).d, normalize(Vec3f(1, 1, 1)));
  const Camera ortho =
      readOptions(film + "Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]")
          .cameras.at(0);
  const Ray corner = generateRay(ortho, {100, 0}, {});
  EXPECT_NEAR(corner.o.x, 2, 1e-5);
  EXPECT_NEAR(corner.o.y, 2, 1e-5);
  expectAt(corner.d, {0, 0, 1});
  EXPECT_TRUE(
      contains(findingsOf(readOptions(film + "Camera \"perspective\" \"float screenwindow\" "
                                             "[-2 2 -1 1]")),
               "not square"));
  EXPECT_TRUE(contains(messageOf<InputError>([] { readOptions("Camera \"realistic\""); }),
                       "not supported"));
  EXPECT_TRUE(contains(
      messageOf<InputError>([] { readOptions("Film \"rgb\" \"integer xresolution\" -5"); }),
      "impossible"));
}

TEST(PbrtSyntax, SensorsScaleLight) {
  const TemporaryFolder folder;
  const Scene scene =
      readPbrtText(folder,
                   "Film \"rgb\" \"float iso\" 200 \"float exposuretime\" 0.25 \"string sensor\" "
                   "\"canon_eos_5d\"\nWorldBegin LightSource \"point\" \"rgb I\" [4 2 0]");
  expectAt(colorOf(scene.emitters.at(0)), {2, 1, 0});
  EXPECT_TRUE(contains(findingsOf(scene), "canon_eos_5d"));
}

TEST(PbrtSyntax, HintsAreNoReasonToRefuse) {
  const Scene scene = readOptions(
      "Integrator \"vcm\" Sampler \"magic\" Film \"foil\" "
      "PixelFilter \"coffee\" Accelerator \"bvh\"");
  EXPECT_EQ(scene.cameras.size(), 1u);
  for (const char* name : {"vcm", "magic", "foil", "coffee"})
    EXPECT_TRUE(contains(findingsOf(scene), name)) << name;
}

}  // namespace
}  // namespace lobelia::test
