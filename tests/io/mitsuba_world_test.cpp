// Shapes and emitters.
#include <numbers>

#include "io/mitsuba_scene.h"

namespace lobelia {
namespace {

using test::onlyFinding;
using test::readLegacy;
using test::readModern;
using test::refusal;

constexpr float kDegree = std::numbers::pi_v<float> / 180;

void expectNear(Vec3f a, Vec3f b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f) << c;
}

TEST(MitsubaShape, UnitShapesAreShared) {
  const Scene scene = readModern(
      "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/><float "
      "name=\"radius\" value=\"2\"/></shape><shape type=\"sphere\"/><shape type=\"disk\"/>"
      "<shape type=\"rectangle\"/><shape type=\"cube\"/>");
  EXPECT_EQ(scene.meshes.size(), 4u);
  EXPECT_EQ(scene.instances.size(), 5u);
  EXPECT_TRUE(scene[scene.instances[0].mesh].isUnitSphere);
  expectNear(scene.instances[0].toWorld.point({1, 0, 0}), {3, 2, 3});
  EXPECT_TRUE(scene.findings.empty());
}

TEST(MitsubaShape, CylindersReachFromP0ToP1) {
  const Scene scene = readModern(
      "<shape type=\"cylinder\"><point name=\"p0\" value=\"1 2 3\"/><point name=\"p1\" value=\"1 6 "
      "3\"/><float name=\"radius\" value=\"0.5\"/></shape>");
  const Transform& t = scene.instances[0].toWorld;
  expectNear(t.point({0, 0, 0}), {1, 2, 3});
  expectNear(t.point({0, 0, 1}), {1, 6, 3});
  EXPECT_NEAR(length(t.vector({1, 0, 0})), 0.5f, 1e-6f);
  EXPECT_GT(t.to.determinant3(), 0);
}

TEST(MitsubaShape, GroupsAreFlattened) {
  const Scene scene = readModern(
      "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"><transform name=\"to_world\">"
      "<scale value=\"2\"/></transform></shape><shape type=\"disk\"/></shape>"
      "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"5\"/>"
      "</transform></shape><shape type=\"instance\"><ref id=\"g\"/></shape>");
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.meshes.size(), 2u);
  expectNear(scene.instances[0].toWorld.point({1, 1, 1}), {7, 2, 2});
  expectNear(scene.instances[2].toWorld.point({1, 1, 1}), {2, 2, 2});
  EXPECT_TRUE(contains(refusal("<shape type=\"instance\"/>"), "shapegroup"));
  EXPECT_TRUE(contains(refusal("<shape type=\"shapegroup\" id=\"g\"><shape type=\"instance\"><ref "
                               "id=\"g\"/></shape></shape>"),
                       "cannot hold"));
}

TEST(MitsubaShape, MeshOptionsMakeDifferentMeshes) {
  const TemporaryFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.25\nf 1/1 2/1 3/1\n");
  const std::string file = "<string name=\"filename\" value=\"t.obj\"/>";
  const auto shape = [&](const std::string& options) {
    return "<shape type=\"obj\">" + file + options + "</shape>";
  };
  const Scene scene = test::readText(
      folder, test::modern(shape("") + shape("") +
                           shape("<boolean name=\"face_normals\" value=\"true\"/>") +
                           shape("<boolean name=\"flip_tex_coords\" value=\"false\"/>")));
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_TRUE(scene.instances[0].mesh == scene.instances[1].mesh);
  EXPECT_FALSE(scene.meshes[0].normals.empty());
  EXPECT_TRUE(scene.meshes[1].normals.empty());
  EXPECT_FLOAT_EQ(scene.meshes[0].uvs[0].y, 0.75f);
  EXPECT_FLOAT_EQ(scene.meshes[2].uvs[0].y, 0.25f);
}

// Mitsuba 3 takes the outside of a flat mesh from its transformed triangles, 0.6 does not.
TEST(MitsubaShape, MirroredFlatMeshes) {
  const TemporaryFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto read = [&](bool legacy, const std::string& extra) {
    const std::string body = "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/>" +
                             extra +
                             "<transform name=\"to_world\"><scale x=\"-1\"/></transform></shape>";
    return test::readText(folder, legacy ? test::legacy(body) : test::modern(body))
        .instances[0]
        .flipNormals;
  };
  const std::string flat = "<boolean name=\"face_normals\" value=\"true\"/>";
  EXPECT_TRUE(read(false, flat));
  EXPECT_FALSE(read(true, flat));
  EXPECT_FALSE(read(false, ""));
  EXPECT_FALSE(read(false, flat + "<boolean name=\"flip_normals\" value=\"true\"/>"));
}

TEST(MitsubaShape, SurfacesWithoutMaterial) {
  Scene scene = readModern("<shape type=\"cube\"/>");
  EXPECT_EQ(scene.materials[0].diffuse.value, Rgb(0.5f));
  scene = readModern("<shape type=\"cube\"><emitter type=\"area\"/></shape>");
  EXPECT_EQ(scene.materials[0].diffuse.value, Rgb(0.f));
  scene = readModern("<shape type=\"cube\"/><shape type=\"disk\"/>");
  EXPECT_EQ(scene.materials.size(), 1u);
  const std::string medium =
      "<shape type=\"cube\"><medium type=\"homogeneous\" name=\"interior\"/></shape>";
  EXPECT_EQ(readModern(medium).materials[0].type, MaterialType::diffuse);
  scene = readLegacy(medium);
  EXPECT_EQ(scene.materials[0].type, MaterialType::null);
  EXPECT_TRUE(contains(onlyFinding(scene), "participating media"));
}

TEST(MitsubaShape, MistakesAreRefused) {
  EXPECT_TRUE(contains(refusal("<shape type=\"shpere\"/>"), "did you mean 'sphere'?"));
  EXPECT_TRUE(contains(refusal("<shape type=\"hair\"/>"), "unknown shape 'hair'"));
  EXPECT_TRUE(contains(refusal("<shape type=\"obj\"/>"), "no filename"));
  EXPECT_TRUE(contains(
      refusal("<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>"), "above 0"));
  EXPECT_TRUE(contains(refusal("<shape type=\"cube\"><bsdf type=\"diffuse\"/><bsdf "
                               "type=\"diffuse\"/></shape>"),
                       "only one bsdf"));
  EXPECT_TRUE(
      contains(refusal("<shape type=\"cube\"><emitter type=\"point\"/></shape>"), "only 'area'"));
  EXPECT_TRUE(contains(refusal("<shape type=\"cylinder\"><point name=\"p1\" value=\"0\"/></shape>"),
                       "p0 other than p1"));
}

TEST(MitsubaEmitter, Point) {
  Scene scene = readModern(
      "<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"2\"/>"
      "<rgb name=\"intensity\" value=\"3\"/></emitter>");
  EXPECT_EQ(scene.emitters[0].type, EmitterType::point);
  expectNear(scene.emitters[0].toWorld.point({0, 0, 0}), {1, 2, 0});
  EXPECT_EQ(scene.emitters[0].radiance.value, Rgb(3.f));
  EXPECT_TRUE(contains(refusal("<emitter type=\"point\"><point name=\"position\" x=\"1\"/>"
                               "<transform name=\"to_world\"/></emitter>"),
                       "one of them"));
}

TEST(MitsubaEmitter, SpotInDegrees) {
  Scene scene = readModern("<emitter type=\"spot\"/>");
  EXPECT_NEAR(scene.emitters[0].cutoff, 20 * kDegree, 1e-6f);
  EXPECT_NEAR(scene.emitters[0].beamWidth, 15 * kDegree, 1e-6f);
  scene = readLegacy(
      "<emitter type=\"spot\"><float name=\"cutoffAngle\" value=\"40\"/>"
      "<float name=\"beamWidth\" value=\"10\"/></emitter>");
  EXPECT_NEAR(scene.emitters[0].cutoff, 40 * kDegree, 1e-6f);
  EXPECT_NEAR(scene.emitters[0].beamWidth, 10 * kDegree, 1e-6f);
  EXPECT_TRUE(contains(refusal("<emitter type=\"spot\"><float name=\"beam_width\" value=\"30\"/>"
                               "</emitter>"),
                       "impossible"));
}

TEST(MitsubaEmitter, DirectionalInWorldSpace) {
  Scene scene = readModern(
      "<emitter type=\"directional\"><vector name=\"direction\" "
      "value=\"0, 0, -2\"/></emitter>");
  expectNear(scene.emitters[0].direction, {0, 0, -1});
  scene = readModern(
      "<emitter type=\"directional\"><transform name=\"to_world\"><rotate x=\"1\" "
      "angle=\"90\"/></transform></emitter>");
  expectNear(scene.emitters[0].direction, {0, -1, 0});
  EXPECT_TRUE(contains(refusal("<emitter type=\"directional\"><vector name=\"direction\" "
                               "value=\"0\"/></emitter>"),
                       "zero"));
}

TEST(MitsubaEmitter, AreaOnShapes) {
  const Scene scene = readModern(
      "<shape type=\"rectangle\"><emitter type=\"area\"><spectrum name=\"radiance\" value=\"400:0, "
      "500:8, 600:15.6, 700:18.4\"/></emitter></shape>");
  ASSERT_EQ(scene.emitters.size(), 1u);
  EXPECT_EQ(scene.instances[0].emitter.index, 0u);
  const Rgb radiance = scene.emitters[0].radiance.value;
  EXPECT_GT(radiance.x, radiance.y);  // a warm light, brighter than any reflectance
  EXPECT_GT(radiance.y, radiance.z);
  EXPECT_GT(radiance.x, 10);
  EXPECT_TRUE(contains(refusal("<emitter type=\"area\"/>"), "inside a shape"));
}

TEST(MitsubaEmitter, Blackbody) {
  const Scene legacy = readLegacy(
      "<emitter type=\"constant\"><blackbody name=\"radiance\" "
      "temperature=\"3000K\" scale=\"0.5\"/></emitter>");
  const Scene modern = readModern(
      "<emitter type=\"constant\"><spectrum type=\"blackbody\" "
      "name=\"radiance\"><float name=\"temperature\" value=\"3000\"/>"
      "</spectrum></emitter>");
  const Rgb half = legacy.emitters[0].radiance.value, whole = modern.emitters[0].radiance.value;
  EXPECT_GT(whole.x, 2 * whole.z);
  expectNear(half / whole, Rgb(0.5f));
  EXPECT_TRUE(contains(refusal("<emitter type=\"constant\"><blackbody name=\"radiance\" "
                               "temperature=\"0\"/></emitter>"),
                       "above 0"));
}

TEST(MitsubaEmitter, OneEnvironment) {
  const TemporaryFolder folder;
  folder.write("e.pgm", std::string("P5 2 1 255\n\x80\xff", 13));
  const std::string map =
      "<emitter type=\"envmap\"><string name=\"filename\" value=\"e.pgm\"/><float name=\"scale\" "
      "value=\"2\"/></emitter>";
  const Scene scene = test::readText(folder, test::modern(map));
  EXPECT_EQ(scene.emitters[0].type, EmitterType::environment);
  EXPECT_EQ(scene.emitters[0].scale, 2);
  EXPECT_TRUE(scene.emitters[0].image.valid());
  EXPECT_THROW(test::readText(folder, test::modern(map + "<emitter type=\"constant\"/>")),
               InputError);
  // --environment replaces one and leaves the handles of the others.
  io::ReadSettings settings;
  settings.environment = folder.path("e.pgm");
  const Scene replaced =
      test::readText(folder,
                     test::modern("<emitter type=\"constant\"/><shape type=\"cube\"><emitter "
                                  "type=\"area\"/></shape>"),
                     settings);
  ASSERT_EQ(replaced.emitters.size(), 2u);
  EXPECT_EQ(replaced.emitters[replaced.instances[0].emitter.index].type, EmitterType::area);
  const Scene added = test::readText(folder, test::modern(""), settings);
  EXPECT_EQ(added.emitters.at(0).type, EmitterType::environment);
  settings.environment = folder.path("gone.hdr");
  EXPECT_THROW(test::readText(folder, test::modern(""), settings), InputError);
}

TEST(MitsubaEmitter, ProjectorFieldOfView) {
  const TemporaryFolder folder;
  folder.write("e.pgm", std::string("P5 2 1 255\n\x80\xff", 13));
  const Scene scene = test::readText(
      folder,
      test::modern("<emitter type=\"projector\"><float name=\"fov\" value=\"60\"/><string "
                   "name=\"fov_axis\" value=\"y\"/><texture name=\"irradiance\" type=\"bitmap\">"
                   "<string name=\"filename\" value=\"e.pgm\"/></texture></emitter>"));
  EXPECT_NEAR(std::tan(scene.emitters[0].fov / 2), 2 * std::tan(30 * kDegree), 1e-5f);
}

TEST(MitsubaEmitter, UnknownTypesAreErrors) {
  EXPECT_TRUE(contains(refusal("<emitter type=\"spott\"/>"), "did you mean 'spot'?"));
  EXPECT_TRUE(contains(refusal("<emitter type=\"sunlight\"/>"), "unknown emitter 'sunlight'"));
}

}  // namespace
}  // namespace lobelia
