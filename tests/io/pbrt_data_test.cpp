// Real PBRT scenes, and staircase2 as PBRT against staircase2 as Mitsuba XML.
#include <gtest/gtest.h>

#include "io/pbrt_scene.h"
#include "support/data.h"

namespace lobelia::test {
namespace {

std::optional<Scene> readShared(const std::string& file) {
  const std::string path = sharedFolder() + "/data/scenes/" + file;
  if (sharedFolder().empty() || !std::filesystem::exists(path)) return std::nullopt;
  Context context;
  return io::readScene(path, {}, context);
}

TEST(PbrtData, RealScenesReadWithoutWarnings) {
  const std::pair<const char*, uint64_t> scenes[] = {
      {"coffee", 235271}, {"veach-ajar", 382690}, {"veach-mis", 195124}, {"staircase2", 32207}};
  for (const auto& [name, triangles] : scenes) {
    const auto scene = readShared(std::string("pbrt/") + name + "/scene-v4.pbrt");
    if (!scene) GTEST_SKIP() << "no shared scenes";
    EXPECT_EQ(scene->name, name);
    EXPECT_EQ(findingsOf(*scene), "") << name;
    // Round shapes are counted as they are tessellated.
    if (std::string(name) == "coffee" || std::string(name) == "veach-ajar") {
      EXPECT_EQ(triangleCount(*scene), triangles);
    }
    for (const Finding& f : validate(*scene))
      EXPECT_NE(f.severity, Severity::error) << name << ": " << f.message;
  }
}

// The same camera, triangles' bounds and lamps; the floor was altered in the Mitsuba file.
TEST(PbrtData, Staircase2InBothFormats) {
  const auto pbrt = readShared("pbrt/staircase2/scene-v4.pbrt");
  const auto mitsuba = readShared("mitsuba/staircase2/scene.xml");
  if (!pbrt || !mitsuba) GTEST_SKIP() << "no shared scenes";
  const Camera &a = pbrt->cameras.at(0), &b = mitsuba->cameras.at(0);
  EXPECT_NEAR(a.fovX, b.fovX, 1e-5f);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(a.toWorld.to.m[i][j], b.toWorld.to.m[i][j], 1e-4) << i << j;
  ASSERT_EQ(pbrt->emitters.size(), mitsuba->emitters.size());
  for (size_t i = 0; i < pbrt->emitters.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(colorOf(pbrt->emitters[i])[c], colorOf(mitsuba->emitters[i])[c], 1e-4f);
  ASSERT_EQ(pbrt->instances.size(), mitsuba->instances.size());
  int altered = 0;
  for (size_t i = 0; i < pbrt->instances.size(); ++i) {
    const auto typeOf = [&](const Scene& s) {
      const Material& m = s[s.instances[i].material];
      return m.type == MaterialType::twoSided ? s[m.a].type : m.type;
    };
    if (typeOf(*pbrt) == typeOf(*mitsuba)) continue;
    ++altered;
    EXPECT_EQ(typeOf(*pbrt), MaterialType::roughPlastic);
    EXPECT_EQ(typeOf(*mitsuba), MaterialType::principled);
  }
  EXPECT_EQ(altered, 1);
}

}  // namespace
}  // namespace lobelia::test
