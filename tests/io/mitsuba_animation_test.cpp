// Moving sensors: <animation> of Mitsuba 0.6, read and written.
#include "io/mitsuba_scene.h"
#include "lobelia/scene/camera_path.h"

namespace lobelia {
namespace {

const char* kKeys = R"(<animation name="toWorld">
    <transform time="1"><lookAt origin="0,0,0" target="0,0,1" up="0,1,0"/></transform>
    <transform time="3"><lookAt origin="4,0,0" target="5,0,0" up="0,1,0"/></transform>
    <transform time="3.5"><translate x="4" y="1"/></transform>
  </animation>)";

std::string scene(const std::string& animation) {
  return "<scene version=\"0.6.0\">\n<sensor type=\"perspective\">\n" + animation +
         "\n</sensor></scene>";
}

std::string refused(const std::string& animation) {
  const TemporaryFolder folder;
  return messageOf<InputError>([&] { test::readText(folder, scene(animation)); });
}

TEST(MitsubaAnimation, KeysAndThePlaceAtATime) {
  const TemporaryFolder folder;
  const Scene first = test::readText(folder, scene(kKeys));
  EXPECT_TRUE(first.findings.empty()) << first.findings[0].message;
  const Camera& c = first.cameras.at(0);
  ASSERT_EQ(c.path.size(), 3u);
  EXPECT_EQ(c.path[0].time, 1);
  EXPECT_EQ(c.path[2].time, 3.5f);
  EXPECT_EQ(c.toWorld.to, c.path[0].toWorld.to);  // time 0 is before the first key
  EXPECT_EQ(c.path[2].toWorld.to, translation({4, 1, 0}));
  io::ReadSettings settings;
  settings.time = 2;
  const Scene later = test::readText(folder, scene(kKeys), settings);
  EXPECT_EQ(later.cameras[0].toWorld.point({}), Vec3f(2, 0, 0));
  const Vec3f view = later.cameras[0].toWorld.vector({0, 0, 1});
  EXPECT_NEAR(view.x, std::sqrt(0.5f), 1e-6f);
  EXPECT_NEAR(view.z, std::sqrt(0.5f), 1e-6f);
}

TEST(MitsubaAnimation, IsWrittenAndReadBackIdentically) {
  const TemporaryFolder folder;
  const Scene scene1 = test::readText(folder, scene(kKeys));
  io::writeMitsuba(folder.path("out"), scene1);
  Context context;
  const Scene scene2 = io::readMitsuba(folder.path("out") + "/scene.xml", {}, context);
  ASSERT_EQ(scene2.cameras.size(), 1u);
  ASSERT_EQ(scene2.cameras[0].path.size(), 3u);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(scene2.cameras[0].path[k].time, scene1.cameras[0].path[k].time);
    EXPECT_EQ(scene2.cameras[0].path[k].toWorld.to, scene1.cameras[0].path[k].toWorld.to);
  }
  EXPECT_EQ(hash(scene1), hash(scene2));
}

void expectRefused(const std::string& animation, const std::string& line,
                   const std::string& words) {
  const std::string said = refused(animation);
  EXPECT_NE(said.find("scene.xml:" + line + ":"), std::string::npos) << said;
  EXPECT_NE(said.find(words), std::string::npos) << said;
}

TEST(MitsubaAnimation, MistakesAreRefusedWithTheirLine) {
  const std::string open = "<animation name=\"toWorld\">\n";
  expectRefused(open + "</animation>", "3", "no keys");
  expectRefused(open + "<transform time=\"2\"/>\n<transform time=\"2\"/></animation>", "5",
                "times");
  expectRefused(open + "<transform/></animation>", "4", "time");
  expectRefused(open + "<transform time=\"x\"/></animation>", "4", "'x'");
  expectRefused(open +
                    "<transform time=\"0\"/>\n<transform time=\"1\"><scale x=\"-1\"/>"
                    "</transform></animation>",
                "5", "mirror");
}

}  // namespace
}  // namespace lobelia
