// Sensors, films and hints of Mitsuba scenes.
#include <numbers>

#include "io/mitsuba_scene.h"

namespace lobelia {
namespace {

using test::onlyFinding;
using test::readLegacy;
using test::readModern;

constexpr float kDegree = std::numbers::pi_v<float> / 180;

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
