// Sun, sky, photometric emitters and light groups in Mitsuba files.
#include "io/mitsuba_scene.h"

namespace lobelia {
namespace {

using test::onlyFinding;
using test::readLegacy;
using test::readModern;
using test::refusal;

const char* kResolution = "<integer name=\"resolution\" value=\"32\"/>";

TEST(MitsubaSky, SunskyIsAnEnvironmentAndASun) {
  const std::string body = std::string("<emitter type=\"sunsky\" id=\"day\">") + kResolution +
                           "<vector name=\"sunDirection\" value=\"0 1 1\"/><float "
                           "name=\"skyScale\" value=\"2\"/><float name=\"sunScale\" value=\"3\"/>"
                           "<float name=\"sunRadiusScale\" value=\"4\"/></emitter>";
  const Scene scene = readLegacy(body);
  EXPECT_TRUE(scene.findings.empty());
  ASSERT_EQ(scene.emitters.size(), 2u);
  const Emitter &sky = scene.emitters[0], &sun = scene.emitters[1];
  EXPECT_EQ(sky.type, EmitterType::environment);
  EXPECT_EQ(sky.scale, 2);
  EXPECT_EQ(scene[sky.image].width, 32);
  EXPECT_EQ(sun.type, EmitterType::sun);
  EXPECT_NEAR(sun.direction.y, -std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(sun.angularRadius, 4 * 0.2679f * kPi / 180, 1e-5f);
  EXPECT_GT(sun.radiance.value.x, 3 * 1.f);
}

// Up is y in 0.6 and z in Mitsuba 3; the direction to the sun is the world's.
TEST(MitsubaSky, AxesFollowTheDialect) {
  const std::string body = std::string("<emitter type=\"sunsky\">") + kResolution +
                           "<vector name=\"sun_direction\" value=\"0 0.1 1\"/></emitter>";
  const Scene modern = readModern(body);
  ASSERT_EQ(modern.emitters.size(), 2u);
  EXPECT_NEAR(modern.emitters[0].toWorld.vector({0, 1, 0}).z, 1, 1e-6f);
  EXPECT_LT(modern.emitters[1].direction.z, -0.9f);
  EXPECT_GT(modern.emitters[1].radiance.value.y, 1);  // high above
  const Scene legacy = readLegacy(body);
  ASSERT_EQ(legacy.emitters.size(), 2u);
  EXPECT_LT(legacy.emitters[1].radiance.value.y, 0.6f);  // low
}

TEST(MitsubaSky, TimeAndPlaceGiveTheSun) {
  const std::string noon = std::string("<emitter type=\"sun\">") + kResolution +
                           "<integer name=\"month\" value=\"6\"/><integer name=\"day\" "
                           "value=\"21\"/><float name=\"hour\" value=\"12\"/><float "
                           "name=\"latitude\" value=\"45\"/><float name=\"longitude\" "
                           "value=\"0\"/><float name=\"timezone\" value=\"0\"/></emitter>";
  const Scene scene = readLegacy(noon);
  ASSERT_EQ(scene.emitters.size(), 1u);
  const Vec3f d = -scene.emitters[0].direction;
  EXPECT_NEAR(std::asin(d.y) * 180 / kPi, 68.4f, 0.1f);
  EXPECT_GT(d.z, 0.3f);  // in the south
  const Scene modern = readModern(noon);
  EXPECT_NEAR(-modern.emitters.at(0).direction.z, d.y, 1e-5f);
  EXPECT_NEAR(-modern.emitters.at(0).direction.x, d.z, 1e-5f);
  EXPECT_TRUE(contains(refusal("<emitter type=\"sky\"><integer name=\"month\" value=\"13\"/>"
                               "</emitter>"),
                       "month"));
}

TEST(MitsubaSky, SunsetsAndMistakesAreReported) {
  const std::string night = std::string("<emitter type=\"sunsky\">") + kResolution +
                            "<vector name=\"sun_direction\" value=\"0 1 -0.5\"/></emitter>";
  const Scene scene = readModern(night);
  EXPECT_EQ(scene.emitters.size(), 1u);
  EXPECT_TRUE(contains(onlyFinding(scene), "set"));
  EXPECT_TRUE(contains(refusal("<emitter type=\"sky\"><float name=\"turbidity\" value=\"20\"/>"
                               "</emitter>"),
                       "turbidity"));
  EXPECT_TRUE(contains(onlyFinding(readModern("<emitter type=\"sky\"><float name=\"turbidty\" "
                                              "value=\"2\"/></emitter>")),
                       "turbidity"));
  EXPECT_TRUE(contains(refusal("<emitter type=\"sky\"/><emitter type=\"constant\"/>"), "second"));
}

TEST(MitsubaSky, SunWithItsIrradiance) {
  const Scene scene = readModern(
      "<emitter type=\"sun\"><rgb name=\"irradiance\" value=\"1 2 3\"/><vector name=\"direction\" "
      "value=\"0 -2 0\"/><float name=\"angular_radius\" value=\"0.5\"/></emitter>");
  EXPECT_TRUE(scene.findings.empty());
  EXPECT_EQ(scene.emitters.at(0).type, EmitterType::sun);
  EXPECT_EQ(scene.emitters[0].radiance.value, Rgb(1, 2, 3));
  EXPECT_EQ(scene.emitters[0].direction, Vec3f(0, -1, 0));
  EXPECT_NEAR(scene.emitters[0].angularRadius, 0.5f * kPi / 180, 1e-8f);
}

TEST(MitsubaEmitter, PhotometricFilesAreGoniometric) {
  const TemporaryFolder folder;
  folder.write("lamp.ies",
               "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0 1 1 10\n0 90\n0\n100 50\n");
  const std::string emitter =
      "<emitter type=\"ies\"><string name=\"filename\" value=\"lamp.ies\"/><float name=\"scale\" "
      "value=\"0.5\"/><rgb name=\"intensity\" value=\"1 0.9 0.8\"/></emitter>";
  const Scene scene = test::readText(folder, test::modern(emitter + emitter));
  EXPECT_TRUE(scene.findings.empty());
  ASSERT_EQ(scene.emitters.size(), 2u);
  EXPECT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.emitters[0].type, EmitterType::goniometric);
  EXPECT_EQ(scene.emitters[0].scale, 0.5f);
  EXPECT_EQ(scene.emitters[0].radiance.value, Rgb(1, 0.9f, 0.8f));
  EXPECT_EQ(scene.images[0].at(0, 0, 0), 100);
  EXPECT_TRUE(contains(refusal("<emitter type=\"ies\"/>"), "filename"));
  folder.write("bad.ies", "no\n");
  EXPECT_TRUE(contains(messageOf<InputError>([&] {
                         test::readText(folder, test::modern("<emitter type=\"ies\"><string "
                                                             "name=\"filename\" value=\"bad.ies\"/>"
                                                             "</emitter>"));
                       }),
                       "bad.ies:"));
}

TEST(MitsubaEmitter, EmittersOnNullMaterialsShine) {
  const Scene scene = readModern(
      "<shape type=\"sphere\"><bsdf type=\"null\"/><emitter type=\"area\"/></shape>");
  EXPECT_TRUE(contains(onlyFinding(scene), "black"));
  EXPECT_EQ(scene[scene.instances[0].material].type, MaterialType::diffuse);
  for (const Finding& finding : validate(scene))
    EXPECT_FALSE(contains(finding.message, "null")) << finding.message;
}

TEST(MitsubaEmitter, GroupsOfAllKinds) {
  const std::string group = "<string name=\"group\" value=\"window\"/>";
  const Scene scene = readModern("<shape type=\"sphere\"><emitter type=\"area\">" + group +
                                 "</emitter></shape><emitter type=\"point\">" + group +
                                 "</emitter><emitter type=\"sunsky\">" + kResolution + group +
                                 "<vector name=\"sun_direction\" value=\"0 0 1\"/></emitter>"
                                 "<emitter type=\"point\"/>");
  EXPECT_TRUE(scene.findings.empty());
  ASSERT_EQ(scene.emitters.size(), 5u);
  int without = 0;
  for (const Emitter& e : scene.emitters) without += e.group.empty();
  EXPECT_EQ(without, 1);
  EXPECT_EQ(scene.emitters[scene.instances[0].emitter.index].group, "window");
}

}  // namespace
}  // namespace lobelia
