// Designs: what a file of changes does to a scene.
#include "lobelia/io/design.h"

#include "io/mitsuba_scene.h"

namespace lobelia {
namespace {

constexpr const char* kScene =
    "<scene version=\"3.0.0\">\n"
    "<bsdf type=\"twosided\"><bsdf type=\"diffuse\" id=\"wall\"/></bsdf>\n"
    "<bsdf type=\"roughconductor\" id=\"steel\"><float name=\"alpha\" value=\"0.1\"/></bsdf>\n"
    "<shape type=\"sphere\"><ref id=\"steel\"/></shape>\n"
    "<shape type=\"rectangle\"><emitter type=\"area\" id=\"panel\"/></shape>\n"
    "<emitter type=\"point\" id=\"lamp\"/>\n"
    "<emitter type=\"constant\"/>\n"
    "<sensor type=\"perspective\" id=\"front\"><float name=\"fov\" value=\"30\"/>\n"
    "<film type=\"hdrfilm\"><integer name=\"width\" value=\"320\"/>"
    "<integer name=\"height\" value=\"200\"/></film></sensor>\n"
    "</scene>";

Scene changed(const std::string& design, const io::ReadSettings& settings = {}) {
  const TemporaryFolder folder;
  Scene scene = test::readText(folder, kScene);
  Context context;
  io::applyDesign(folder.write("design.xml", "<scene version=\"3.0.0\">\n" + design + "</scene>"),
                  settings, scene, context);
  return scene;
}
std::string refused(const std::string& design) {
  return messageOf<InputError>([&] { changed(design); });
}

const Material& namedMaterial(const Scene& scene, const std::string& name) {
  for (const Material& m : scene.materials)
    if (m.name == name) return m;
  throw std::out_of_range(name);
}

TEST(Design, NothingChangesByNothing) {
  const TemporaryFolder folder;
  EXPECT_EQ(hash(changed("")), hash(test::readText(folder, kScene)));
}

TEST(Design, MaterialsTakeThePlaceOfThoseOfTheirName) {
  const Scene scene = changed(
      "<bsdf type=\"bumpmap\" id=\"steel\"><texture type=\"checkerboard\"/>"
      "<float name=\"scale\" value=\"2\"/>"
      "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.4\"/></bsdf></bsdf>");
  const Material& steel = scene[scene.instances[0].material];
  EXPECT_EQ(steel.name, "steel");
  EXPECT_EQ(steel.type, MaterialType::bump);
  EXPECT_EQ(scene[steel.a].alphaU.value, 0.4f);
  EXPECT_EQ(scene[steel.map].type, TextureType::checkerboard);
  EXPECT_TRUE(validate(scene).empty());
}

// It stays wrapped.
TEST(Design, MaterialsInsideOthersAreFound) {
  const Scene scene = changed(
      "<bsdf type=\"diffuse\" id=\"wall\"><rgb name=\"reflectance\" value=\"0.1 0.2 "
      "0.3\"/></bsdf>");
  EXPECT_EQ(namedMaterial(scene, "wall").diffuse.value, Rgb(0.1f, 0.2f, 0.3f));
  bool wrapped = false;
  for (const Material& m : scene.materials)
    wrapped = wrapped || (m.type == MaterialType::twoSided && scene[m.a].name == "wall");
  EXPECT_TRUE(wrapped);
}

TEST(Design, EmittersByTheirRoleOrName) {
  const Scene scene = changed(
      "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"3 2 1\"/></emitter>"
      "<emitter type=\"spot\" id=\"lamp\"/>"
      "<emitter type=\"area\" id=\"panel\"><rgb name=\"radiance\" value=\"7\"/></emitter>"
      "<emitter type=\"point\" id=\"candle\"/>");
  ASSERT_EQ(scene.emitters.size(), 4u);
  const Emitter& panel = scene[scene.instances[1].emitter];
  EXPECT_EQ(panel.type, EmitterType::area);
  EXPECT_EQ(panel.radiance.value, Rgb(7.f));
  size_t constants = 0, spots = 0, points = 0;
  for (const Emitter& e : scene.emitters) {
    constants += e.type == EmitterType::constant && e.radiance.value == Rgb(3, 2, 1) ? 1 : 0;
    spots += e.type == EmitterType::spot ? 1 : 0;
    points += e.type == EmitterType::point ? 1 : 0;
  }
  EXPECT_EQ(constants, 1u);
  EXPECT_EQ(spots, 1u);
  EXPECT_EQ(points, 1u);
}

// Whatever they are called.
TEST(Design, EnvironmentsTakeTheirPlaceFirst) {
  for (const char* name : {"panel", "lamp"}) {
    const Scene scene = changed(std::string("<emitter type=\"constant\" id=\"") + name +
                                "\"><rgb name=\"radiance\" value=\"3 2 1\"/></emitter>");
    ASSERT_EQ(scene.emitters.size(), 3u);
    size_t constants = 0;
    for (const Emitter& e : scene.emitters)
      constants += e.type == EmitterType::constant && e.radiance.value == Rgb(3, 2, 1) ? 1 : 0;
    EXPECT_EQ(constants, 1u);
    EXPECT_EQ(scene[scene.instances[1].emitter].type, EmitterType::area);
  }
  EXPECT_NE(refused("<emitter type=\"constant\"/>\n<emitter type=\"constant\"/>")
                .find("second environment"),
            std::string::npos);
}

TEST(Design, SensorsKeepTheFilmOfWhatTheyReplace) {
  const Scene replaced = changed(
      "<sensor type=\"perspective\" id=\"front\"><float name=\"fov\" value=\"40\"/></sensor>");
  ASSERT_EQ(replaced.cameras.size(), 1u);
  EXPECT_EQ(replaced.cameras[0].width, 320);
  EXPECT_EQ(replaced.cameras[0].height, 200);
  EXPECT_NEAR(replaced.cameras[0].fovX, 40 * kPi / 180, 1e-6f);
  const Scene added = changed(
      "<sensor type=\"perspective\" id=\"top\"><float name=\"fov\" value=\"40\"/>"
      "<string name=\"fov_axis\" value=\"y\"/></sensor>");
  ASSERT_EQ(added.cameras.size(), 2u);
  EXPECT_EQ(added.cameras[0].name, "top");
  EXPECT_EQ(added.cameras[0].width, 320);
  EXPECT_NEAR(std::tan(added.cameras[0].fovX / 2), 1.6f * std::tan(20 * kPi / 180), 1e-5f);
}

TEST(Design, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(refused("<bsdf type=\"diffuse\" id=\"stel\"/>").find("did you mean 'steel'"),
            std::string::npos);
  EXPECT_NE(refused("<bsdf type=\"diffuse\" id=\"stel\"/>").find("design.xml:2"),
            std::string::npos);
  EXPECT_NE(refused("<bsdf type=\"diffuse\"/>").find("no id"), std::string::npos);
  EXPECT_NE(refused("<shape type=\"sphere\"/>").find("a design has no <shape>"), std::string::npos);
  EXPECT_NE(refused("<emitter type=\"area\" id=\"pane\"/>").find("did you mean 'panel'"),
            std::string::npos);
  EXPECT_NE(refused("<emitter type=\"point\" id=\"panel\"/>").find("only one of type area"),
            std::string::npos);
  EXPECT_NE(refused("<bsdf type=\"difuse\" id=\"steel\"/>").find("did you mean 'diffuse'"),
            std::string::npos);
  io::ReadSettings strict;
  strict.strict = true;
  EXPECT_THROW(
      changed("<bsdf type=\"diffuse\" id=\"steel\"><float name=\"x\" value=\"1\"/></bsdf>", strict),
      InputError);
}

}  // namespace
}  // namespace lobelia
