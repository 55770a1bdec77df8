// Shapes, emitters, sensors and hints.
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

Scene readSensor(const std::string& sensor, bool legacy = false) {
  const TemporaryFolder folder;
  return test::readText(folder, std::string("<scene version=\"") + (legacy ? "0.6.0" : "3.0.0") +
                                    "\">" + sensor + "</scene>");
}
Camera camera(const std::string& body, const std::string& type = "perspective") {
  const Scene scene = readSensor("<sensor type=\"" + type + "\">" + body + "</sensor>");
  EXPECT_TRUE(scene.findings.empty()) << scene.findings[0].message;
  return scene.cameras.at(0);
}
std::string refusedSensor(const std::string& body, const std::string& type = "perspective") {
  return messageOf<InputError>(
      [&] { readSensor("<sensor type=\"" + type + "\">" + body + "</sensor>"); });
}
std::string film(int width, int height, const std::string& body = "") {
  return "<film type=\"hdrfilm\"><integer name=\"width\" value=\"" + std::to_string(width) +
         "\"/><integer name=\"height\" value=\"" + std::to_string(height) + "\"/>" + body +
         "</film>";
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

TEST(MitsubaSensor, Defaults) {
  const Camera c = camera("");
  EXPECT_EQ(c.width, 768);
  EXPECT_EQ(c.height, 576);
  EXPECT_EQ(c.filter, PixelFilter::gaussian);
  EXPECT_EQ(c.cropX1, 0);
  EXPECT_EQ(c.spp, 0);
  EXPECT_EQ(c.apertureRadius, 0);
  // 50 mm on 35 mm film, by the diagonal of 43.27 mm.
  const float half = std::sqrt(36.f * 36 + 24 * 24) / 100;
  EXPECT_NEAR(std::tan(c.fovX / 2), half / std::sqrt(1 + sqr(576.f / 768)), 1e-5f);
}

TEST(MitsubaSensor, FieldOfViewAxes) {
  const auto tangent = [](const std::string& axis, int width, int height) {
    return std::tan(camera("<float name=\"fov\" value=\"60\"/><string name=\"fov_axis\" value=\"" +
                           axis + "\"/>" + film(width, height))
                        .fovX /
                    2);
  };
  const float t = std::tan(30 * kDegree);
  EXPECT_NEAR(tangent("x", 200, 100), t, 1e-5f);
  EXPECT_NEAR(tangent("y", 200, 100), 2 * t, 1e-5f);
  EXPECT_NEAR(tangent("smaller", 200, 100), 2 * t, 1e-5f);
  EXPECT_NEAR(tangent("larger", 200, 100), t, 1e-5f);
  EXPECT_NEAR(tangent("smaller", 100, 200), t, 1e-5f);
  EXPECT_NEAR(tangent("diagonal", 400, 300), t * 0.8f, 1e-5f);
  EXPECT_TRUE(contains(refusedSensor("<float name=\"fov\" value=\"180\"/>"), "180"));
  EXPECT_TRUE(contains(refusedSensor("<float name=\"fov\" value=\"9\"/><string name=\"fov_axis\" "
                                     "value=\"z\"/>"),
                       "diagonal"));
  EXPECT_TRUE(contains(refusedSensor("<float name=\"fov\" value=\"9\"/><string "
                                     "name=\"focal_length\" value=\"50mm\"/>"),
                       "one of them"));
}

TEST(MitsubaSensor, FilmCropAndFilter) {
  const Camera c = camera(
      film(64, 32,
           "<integer name=\"crop_offset_x\" value=\"8\"/><integer name=\"crop_offset_y\" "
           "value=\"4\"/><integer name=\"crop_width\" value=\"16\"/><integer name=\"crop_height\" "
           "value=\"20\"/><rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.4\"/>"
           "</rfilter>") +
      "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"32\"/></sampler>");
  EXPECT_EQ(c.cropX0, 8);
  EXPECT_EQ(c.cropY0, 4);
  EXPECT_EQ(c.cropX1, 24);
  EXPECT_EQ(c.cropY1, 24);
  EXPECT_FLOAT_EQ(c.filterRadius, 1.6f);
  EXPECT_EQ(c.spp, 32);
  EXPECT_EQ(camera(film(4, 4, "<rfilter type=\"box\"/>")).filter, PixelFilter::box);
  EXPECT_EQ(camera(film(4, 4, "<rfilter type=\"tent\"/>")).filter, PixelFilter::tent);
  EXPECT_EQ(camera(film(4, 4, "<rfilter type=\"catmullrom\"/>")).filter, PixelFilter::catmullRom);
  EXPECT_TRUE(
      contains(refusedSensor(film(8, 8, "<integer name=\"crop_width\" value=\"9\"/>")), "crop"));
}

TEST(MitsubaSensor, AbsurdFilmsAreRefused) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{
           {0, 10}, {10, -1}, {1000000000, 1}, {32768, 32768}, {2147483647, 2147483647}}) {
    EXPECT_TRUE(contains(refusedSensor(film(width, height)), "impossible")) << width;
  }
  EXPECT_TRUE(contains(
      refusedSensor("<film type=\"hdrfilm\"><integer name=\"width\" value=\"9999999999\"/></film>"),
      "32 bits"));
}

TEST(MitsubaSensor, ThinLensAndOrthographic) {
  const Camera lens = camera(
      "<float name=\"aperture_radius\" value=\"0.1\"/><float "
      "name=\"focus_distance\" value=\"7\"/>",
      "thinlens");
  EXPECT_FLOAT_EQ(lens.apertureRadius, 0.1f);
  EXPECT_FLOAT_EQ(lens.focusDistance, 7);
  EXPECT_TRUE(contains(refusedSensor("", "thinlens"), "aperture_radius"));
  EXPECT_EQ(camera("", "orthographic").type, CameraType::orthographic);
  EXPECT_TRUE(contains(refusedSensor("", "fisheye"), "unknown sensor 'fisheye'"));
  EXPECT_TRUE(contains(refusedSensor("", "ortographic"), "did you mean 'orthographic'?"));
}

TEST(MitsubaSensor, ShiftAndClip) {
  const Camera c = camera(
      "<float name=\"principal_point_offset_x\" value=\"0.2\"/><float "
      "name=\"principal_point_offset_y\" value=\"-0.1\"/><float "
      "name=\"near_clip\" value=\"1\"/>");
  EXPECT_FLOAT_EQ(c.principalPointOffset.x, 0.2f);
  EXPECT_FLOAT_EQ(c.principalPointOffset.y, -0.1f);
  EXPECT_FLOAT_EQ(c.nearClip, 1);
  EXPECT_TRUE(contains(refusedSensor("<float name=\"near_clip\" value=\"-1\"/>"), "clip"));
}

TEST(MitsubaSensor, SeveralAndNone) {
  const Scene two = readSensor(
      "<sensor type=\"perspective\" id=\"left\"/><sensor "
      "type=\"orthographic\" id=\"right\"/>");
  ASSERT_EQ(two.cameras.size(), 2u);
  EXPECT_EQ(two.cameras[1].name, "right");
  // Without one, a camera sees the whole scene.
  const Scene none = readSensor("<shape type=\"cube\"/>");
  ASSERT_EQ(none.cameras.size(), 1u);
  EXPECT_TRUE(contains(onlyFinding(none), "no sensor"));
  const Vec3f at = none.cameras[0].toWorld.point({0, 0, 0});
  EXPECT_LT(at.z, -1);
  EXPECT_GT(std::tan(none.cameras[0].fovX / 2) * (-1 - at.z), 0.999f);
}

TEST(MitsubaHints, IntegratorsAreLookedThrough) {
  const Scene scene = readModern(
      "<integrator type=\"moment\"><integrator type=\"path\"><integer name=\"max_depth\" "
      "value=\"7\"/><boolean name=\"hide_emitters\" value=\"true\"/></integrator></integrator>");
  EXPECT_EQ(scene.integrator, "path");
  EXPECT_EQ(scene.maxDepth, 7);
  EXPECT_TRUE(scene.hideEmitters);
  EXPECT_TRUE(scene.findings.empty());
  EXPECT_EQ(readLegacy("<integrator type=\"path\"><integer name=\"maxDepth\" value=\"3\"/>"
                       "</integrator>")
                .maxDepth,
            3);
}

TEST(MitsubaHints, NoHintPreventsRendering) {
  for (const char* hint :
       {"<integrator type=\"magic\"/>", "<integrator type=\"$x\"/>",
        "<integrator type=\"path\"><integer name=\"max_depth\" value=\"deep\"/></integrator>",
        "<integrator type=\"path\"><integer name=\"max_depth\" value=\"$deep\"/></integrator>",
        "<integrator type=\"path\"><integer name=\"max_depth\" value=\"-7\"/></integrator>",
        "<integrator type=\"path\"><float name=\"unknown\" value=\"1\"/></integrator>"}) {
    const Scene scene = readModern(hint);
    EXPECT_EQ(scene.findings.size(), 1u) << hint;
    EXPECT_EQ(scene.maxDepth, -1) << hint;
  }
  for (const char* hint :
       {"<sampler type=\"magic\"/>",
        "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"$spp\"/></sampler>",
        "<sampler type=\"independent\"><integer name=\"sample_count\" value=\"0\"/></sampler>",
        "<film type=\"magicfilm\"/>", "<film type=\"hdrfilm\"><rfilter type=\"magic\"/></film>",
        "<film type=\"hdrfilm\"><rfilter type=\"$f\"/></film>"}) {
    const Scene scene =
        readSensor("<sensor type=\"perspective\">" + std::string(hint) + "</sensor>");
    EXPECT_EQ(scene.findings.size(), 1u) << hint;
    EXPECT_EQ(scene.cameras[0].spp, 0) << hint;
  }
  // The output's name may be anything.
  EXPECT_TRUE(readSensor("<sensor type=\"perspective\"><film type=\"hdrfilm\"><string "
                         "name=\"filename\" value=\"$out\"/></film></sensor>")
                  .findings.empty());
}

}  // namespace
}  // namespace lobelia
