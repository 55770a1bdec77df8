// Property values and transforms.
#include "io/mitsuba_scene.h"

namespace lobelia {
namespace {

using test::onlyFinding;
using test::readLegacy;
using test::readModern;
using test::refusal;

std::string cubeWith(const std::string& operations) {
  return "<shape type=\"cube\"><transform name=\"to_world\">" + operations + "</transform></shape>";
}

Vec3f placed(const std::string& operations, Vec3f p) {
  return readModern(cubeWith(operations)).instances[0].toWorld.point(p);
}

void expectNear(Vec3f a, Vec3f b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f) << c;
}

Rgb reflectance(const std::string& element) {
  return readModern("<bsdf type=\"diffuse\">" + element + "</bsdf>").materials[0].diffuse.value;
}

std::string refusedReflectance(const std::string& element) {
  return refusal("<bsdf type=\"diffuse\">" + element + "</bsdf>");
}

TEST(MitsubaTransform, OperationsApplyInOrder) {
  expectNear(placed("<scale value=\"2\"/><translate x=\"1\"/>", {1, 1, 1}), {3, 2, 2});
  expectNear(placed("<translate x=\"1\"/><scale value=\"2\"/>", {1, 1, 1}), {4, 2, 2});
  expectNear(placed("<rotate z=\"1\" angle=\"90\"/>", {1, 0, 0}), {0, 1, 0});
  expectNear(placed("<rotate value=\"0 1 0\" angle=\"90\"/>", {0, 0, 1}), {1, 0, 0});
  expectNear(placed("<scale x=\"3\"/>", {1, 1, 1}), {3, 1, 1});
  expectNear(placed("<translate value=\"1, 2, 3\"/>", {0, 0, 0}), {1, 2, 3});
}

TEST(MitsubaTransform, Matrices) {
  expectNear(placed("<matrix value=\"0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1\"/>", {1, 0, 0}), {5, 7, 7});
  expectNear(placed("<matrix value=\"0 -1 0 1 0 0 0 0 2\"/>", {1, 0, 1}), {0, 1, 2});
}

TEST(MitsubaTransform, LookAtLooksAlongZ) {
  const std::string l = "<lookat origin=\"1 2 3\" target=\"1 2 8\" up=\"0 1 0\"/>";
  expectNear(placed(l, {0, 0, 0}), {1, 2, 3});
  expectNear(placed(l, {0, 0, 1}), {1, 2, 4});
  expectNear(placed(l, {1, 0, 0}), {2, 2, 3});  // x is to the left of a viewer along +z
  // In 0.6 the tag is lookAt too; up may be missing.
  const Scene scene = readLegacy(
      "<shape type=\"cube\"><transform name=\"toWorld\"><lookAt origin=\"0,0,0\" "
      "target=\"0,1,0\"/></transform></shape>");
  expectNear(scene.instances[0].toWorld.vector({0, 0, 1}), {0, 1, 0});
}

TEST(MitsubaTransform, ImpossibleOnesAreRefused) {
  EXPECT_TRUE(contains(refusal(cubeWith("<scale x=\"0\"/>")), "singular"));
  EXPECT_TRUE(contains(refusal(cubeWith("<matrix value=\"1 2 3\"/>")), "16 or 9"));
  EXPECT_TRUE(
      contains(refusal(cubeWith("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>")), "affine"));
  EXPECT_TRUE(contains(refusal(cubeWith("<translate x=\"nan\"/>")), "not a finite number"));
  EXPECT_TRUE(contains(refusal(cubeWith("<translate x=\"1e39\"/>")), "not a finite number"));
  EXPECT_TRUE(
      contains(refusal(cubeWith("<scale value=\"1e30\"/><scale value=\"1e300\"/>")), "finite"));
  EXPECT_TRUE(contains(refusal(cubeWith("<rotate angle=\"4\"/>")), "axis"));
  EXPECT_TRUE(contains(refusal(cubeWith("<rotate x=\"1\"/>")), "'angle'"));
  EXPECT_TRUE(contains(
      refusal(cubeWith("<lookat origin=\"0 0 0\" target=\"0 0 0\" up=\"0 1 0\"/>")), "direction"));
  EXPECT_TRUE(contains(refusal(cubeWith("<float name=\"x\" value=\"1\"/>")), "<float>"));
  EXPECT_TRUE(contains(refusal(cubeWith("<translate value=\"1 2\"/>")), "one or three"));
  EXPECT_TRUE(contains(refusal(cubeWith("<translate value=\"1\" x=\"2\"/>")), "one of them"));
}

TEST(MitsubaValues, ColoursInEverySpelling) {
  EXPECT_EQ(reflectance("<rgb name=\"reflectance\" value=\"0.1, 0.2, 0.3\"/>"),
            Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(reflectance("<rgb name=\"reflectance\" value=\"0.1 0.2 0.3 \"/>"),
            Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(reflectance("<rgb name=\"reflectance\" value=\"0.4\"/>"), Rgb(0.4f));
  EXPECT_EQ(reflectance("<rgb name=\"reflectance\" value=\"#ff0033\"/>"), Rgb(1, 0, 0.2f));
  EXPECT_EQ(reflectance("<float name=\"reflectance\" value=\"0.4\"/>"), Rgb(0.4f));
  EXPECT_EQ(reflectance("<spectrum name=\"reflectance\" value=\"0.4\"/>"), Rgb(0.4f));
  EXPECT_EQ(reflectance("<spectrum name=\"reflectance\" type=\"uniform\"><float name=\"value\" "
                        "value=\"0.3\"/></spectrum>"),
            Rgb(0.3f));
  EXPECT_NEAR(reflectance("<srgb name=\"reflectance\" value=\"#808080\"/>").y, 0.2158605f, 1e-5f);
  EXPECT_NEAR(reflectance("<srgb name=\"reflectance\" value=\"0.5\"/>").y, 0.2140411f, 1e-5f);
}

TEST(MitsubaValues, SpectraGoThroughTheObserver) {
  const Rgb pairs = reflectance("<spectrum name=\"reflectance\" value=\"360:0.5, 830:0.5\"/>");
  EXPECT_NEAR(luminance(pairs), 0.5f, 2e-3f);
  EXPECT_GT(pairs.x, pairs.z);
  const Rgb regular = reflectance(
      "<spectrum type=\"regular\" name=\"reflectance\"><float name=\"wavelength_min\" "
      "value=\"360\"/><float name=\"wavelength_max\" value=\"830\"/><string name=\"values\" "
      "value=\"0.5, 0.5\"/></spectrum>");
  const Rgb irregular = reflectance(
      "<spectrum type=\"irregular\" name=\"reflectance\"><string name=\"wavelengths\" value=\"360, "
      "830\"/><string name=\"values\" value=\"0.5, 0.5\"/></spectrum>");
  EXPECT_EQ(pairs, regular);
  EXPECT_EQ(pairs, irregular);
  // A file, and a reflectance that leaves the gamut.
  const TemporaryFolder folder;
  folder.write("r.spd", "360 1\n830 1\n");
  const Scene scene =
      test::readText(folder, test::modern("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
                                          "filename=\"r.spd\"/></bsdf>"));
  EXPECT_TRUE(contains(onlyFinding(scene), "clamped"));
  EXPECT_EQ(scene.materials[0].diffuse.value.x, 1);
}

TEST(MitsubaValues, NonsenseIsRefused) {
  for (const char* value : {"1.0f", "1 2", "", "nan", "inf", "-inf", "0x10", "1e400", "1,2", "--1"})
    EXPECT_FALSE(
        refusedReflectance("<float name=\"reflectance\" value=\"" + std::string(value) + "\"/>")
            .empty())
        << value;
  EXPECT_TRUE(
      contains(refusedReflectance("<rgb name=\"reflectance\" value=\"1 2\"/>"), "one or three"));
  EXPECT_TRUE(
      contains(refusedReflectance("<rgb name=\"reflectance\" value=\"#12345\"/>"), "not a colour"));
  EXPECT_TRUE(
      contains(refusedReflectance("<rgb name=\"reflectance\" value=\"0 -1 0\"/>"), "negative"));
  EXPECT_TRUE(contains(refusedReflectance("<string name=\"reflectance\" value=\"red\"/>"),
                       "should be a colour"));
  EXPECT_TRUE(contains(refusedReflectance("<spectrum name=\"reflectance\" value=\"400:1 500\"/>"),
                       "wavelength:value"));
  EXPECT_TRUE(contains(refusedReflectance("<spectrum name=\"reflectance\" value=\"500:1 400:1\"/>"),
                       "increase"));
  EXPECT_TRUE(contains(refusedReflectance("<spectrum name=\"reflectance\" value=\"500:1\"/>"),
                       "fewer than two"));
  EXPECT_TRUE(contains(refusedReflectance("<spectrum name=\"reflectance\"/>"), "either"));
  EXPECT_TRUE(contains(refusedReflectance("<rgb name=\"reflectance\"/>"), "'value'"));
}

TEST(MitsubaValues, NumbersBooleansIntegers) {
  const auto sphere = [](const std::string& property) {
    return "<shape type=\"sphere\">" + property + "</shape>";
  };
  EXPECT_TRUE(readModern(sphere("<boolean name=\"flip_normals\" value=\"True\"/>"))
                  .instances[0]
                  .flipNormals);
  EXPECT_TRUE(
      contains(refusal(sphere("<boolean name=\"flip_normals\" value=\"yes\"/>")), "true or false"));
  EXPECT_TRUE(contains(refusal(sphere("<float name=\"flip_normals\" value=\"1\"/>")),
                       "should be a <boolean>"));
  EXPECT_FLOAT_EQ(readModern(sphere("<integer name=\"radius\" value=\"3\"/>"))
                      .instances[0]
                      .toWorld.vector({1, 0, 0})
                      .x,
                  3);
  EXPECT_FLOAT_EQ(readModern(sphere("<float name=\"radius\" value=\" +2.5e0 \"/>"))
                      .instances[0]
                      .toWorld.vector({1, 0, 0})
                      .x,
                  2.5f);
  EXPECT_TRUE(contains(refusal(sphere("<point name=\"center\" x=\"a\"/>")), "'a'"));
}

TEST(MitsubaValues, ThePropertyGivenLastCounts) {
  const Scene scene = readModern(
      "<bsdf type=\"diffuse\"><float name=\"reflectance\" value=\"0.1\"/><float "
      "name=\"reflectance\" value=\"0.2\"/></bsdf>");
  EXPECT_EQ(scene.materials[0].diffuse.value, Rgb(0.2f));
}

}  // namespace
}  // namespace lobelia
