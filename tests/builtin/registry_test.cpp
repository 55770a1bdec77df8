// What holds for every built-in scene of the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "io/scene_text.h"
#include "io/temporary_folder.h"
#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/io/scene_io.h"

namespace lobelia {
namespace {

class EveryBuiltinScene : public testing::TestWithParam<size_t> {
 protected:
  const builtin::BuiltinScene& entry() const { return builtin::builtinScenes()[GetParam()]; }
  // Of a scene whose name this one's begins with, as "tableau-ward" of "tableau".
  bool isVariant() const {
    const std::string name = entry().name;
    for (const builtin::BuiltinScene& other : builtin::builtinScenes())
      if (name.starts_with(std::string(other.name) + "-") && other.triangles == entry().triangles)
        return true;
    return false;
  }
};

// Around the first place where two texts differ; "" when they do not.
std::string firstDifference(const std::string& a, const std::string& b) {
  const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  if (x == a.end() && y == b.end()) return "";
  const size_t at = static_cast<size_t>(x - a.begin()), begin = at < 80 ? 0 : at - 80;
  return a.substr(begin, 160) + " <> " + b.substr(begin, 160);
}

TEST_P(EveryBuiltinScene, HasTheDocumentedNumberOfTriangles) {
  if (isVariant()) GTEST_SKIP() << "the geometry of another scene";
  const Scene scene = builtin::builtinScene(entry().name, 1);
  const auto documented = static_cast<double>(entry().triangles);
  EXPECT_NEAR(static_cast<double>(triangleCount(scene)), documented, 0.1 * documented);
  for (const Finding& f : validate(scene)) ADD_FAILURE() << f.message;
}

TEST_P(EveryBuiltinScene, ComesBackFromAFile) {
  constexpr float kCoarse = 0.05f;
  const Scene scene = builtin::builtinScene(entry().name, kCoarse);
  for (const Finding& f : validate(scene)) ADD_FAILURE() << f.message;
  const TemporaryFolder folder;
  io::writeMitsuba(folder.path("scene"), scene);
  Context context;
  const Scene copy = io::readMitsuba(folder.path("scene/scene.xml"), {}, context);
  for (const Finding& f : copy.findings) ADD_FAILURE() << toString(f.where) << ": " << f.message;
  EXPECT_EQ(firstDifference(test::SceneText(copy).all(), test::SceneText(scene).all()), "");
  EXPECT_EQ(copy.cameras.size(), scene.cameras.size());
}

std::string nameOf(const testing::TestParamInfo<size_t>& info) {
  std::string name = builtin::builtinScenes()[info.param].name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Table, EveryBuiltinScene,
                         testing::Range<size_t>(0, builtin::builtinScenes().size()), nameOf);

TEST(BuiltinScenes, KitchenHasTheLightsOfItsPapers) {
  constexpr float kCoarse = 0.05f;
  const auto count = [](const Scene& scene, EmitterType type) {
    return std::count_if(scene.emitters.begin(), scene.emitters.end(),
                         [&](const Emitter& e) { return e.type == type; });
  };
  const Scene day = builtin::builtinScene("kitchen", kCoarse);
  EXPECT_EQ(hash(day), hash(builtin::builtinScene("kitchen", kCoarse)));
  EXPECT_EQ(count(day, EmitterType::point), 20);
  EXPECT_EQ(count(day, EmitterType::directional), 1);
  const Scene stove = builtin::builtinScene("kitchen-stove", kCoarse);
  ASSERT_EQ(stove.emitters.size(), 1u);
  EXPECT_EQ(stove.emitters[0].type, EmitterType::area);
  // The lamps shine down, from under the hood.
  int lamps = 0;
  for (const Instance& instance : stove.instances)
    if (instance.emitter.valid()) {
      ++lamps;
      const Vec3u t = stove[instance.mesh].triangles[0];
      const auto corner = [&](uint32_t i) {
        return instance.toWorld.point(stove[instance.mesh].positions[i]);
      };
      EXPECT_LT(cross(corner(t.y) - corner(t.x), corner(t.z) - corner(t.x)).y, 0);
    }
  EXPECT_EQ(lamps, 2);
  for (const char* name : {"kitchen", "kitchen-stove", "kitchen-view2"}) {
    std::set<std::string> cameras;
    for (const Camera& c : builtin::builtinScene(name, kCoarse).cameras) cameras.insert(c.name);
    EXPECT_EQ(cameras, (std::set<std::string>{"main", "second"})) << name;
  }
}

}  // namespace
}  // namespace lobelia
