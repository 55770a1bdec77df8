// Real scenes: everything loads, and what the reader reports is what is known of them.
#include "io/mitsuba_scene.h"
#include "support/data.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

class MitsubaData : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::sharedFolder();
    if (folder_.empty()) GTEST_SKIP() << "no shared data";
  }
  std::string scenes(const std::string& name) const {
    return folder_ + "/data/scenes/mitsuba/" + name + "/scene.xml";
  }
  Scene read(const std::string& file) const {
    Context context;
    Scene scene = io::readScene(file, {}, context);
    // What the meshes' own files are reported for is the mesh readers' affair.
    std::erase_if(scene.findings, [](const Finding& f) { return !f.where.file.ends_with(".xml"); });
    return scene;
  }
  std::string folder_;
};

std::vector<std::string> messages(const Scene& scene) {
  std::vector<std::string> out;
  for (const Finding& f : scene.findings) {
    EXPECT_GT(f.where.line, 0) << f.message;
    out.push_back(f.message);
  }
  return out;
}

TEST_F(MitsubaData, ReferenceScenesLoadWithoutFindings) {
  const fs::path root = fs::path(folder_) / "references/mitsuba/tests/scenes";
  if (!fs::is_directory(root)) GTEST_SKIP() << "no reference scenes";
  int count = 0;
  for (const auto& folder : fs::directory_iterator(root)) {
    for (const auto& file : fs::directory_iterator(folder)) {
      if (file.path().extension() != ".xml") continue;
      const Scene scene = read(file.path().string());
      EXPECT_TRUE(scene.findings.empty()) << file.path() << ": " << scene.findings[0].message;
      EXPECT_FALSE(scene.instances.empty()) << file.path();
      EXPECT_FALSE(scene.emitters.empty()) << file.path();
      EXPECT_EQ(scene.cameras.size(), 1u) << file.path();
      ++count;
    }
  }
  EXPECT_GE(count, 13);
}

TEST_F(MitsubaData, CornellBox) {
  if (!fs::exists(scenes("cornell-box"))) GTEST_SKIP();
  const Scene scene = read(scenes("cornell-box"));
  EXPECT_EQ(scene.name, "cornell-box");
  EXPECT_EQ(triangleCount(scene), 36u);
  EXPECT_EQ(scene.emitters.at(0).radiance.value, Rgb(17, 12, 4));
  EXPECT_NEAR(scene.cameras[0].fovX, 19.5f * kPi / 180, 1e-6f);
  EXPECT_EQ(scene.cameras[0].filter, PixelFilter::tent);
  EXPECT_EQ(scene.maxDepth, 65);
  EXPECT_EQ(messages(scene).size(), 4u);  // <mode>, sampleNum, delta; nothing is twosided
  // Its back wall faces away: shaded from both sides as in the program that wrote it.
  for (const Instance& i : scene.instances) {
    EXPECT_EQ(scene[i.material].type, MaterialType::twoSided) << i.name;
  }
}

TEST_F(MitsubaData, LivingRoom) {
  if (!fs::exists(scenes("living-room"))) GTEST_SKIP();
  const Scene scene = read(scenes("living-room"));
  EXPECT_EQ(triangleCount(scene), 143163u);
  EXPECT_EQ(scene.emitters.at(0).type, EmitterType::environment);
  ASSERT_EQ(messages(scene).size(), 1u);
  EXPECT_TRUE(contains(messages(scene)[0], "high_quality_edges"));
}

TEST_F(MitsubaData, VeachBidir) {
  if (!fs::exists(scenes("veach-bidir"))) GTEST_SKIP();
  const Scene scene = read(scenes("veach-bidir"));
  EXPECT_EQ(scene.emitters.size(), 2u);
  EXPECT_EQ(messages(scene).size(), 5u);  // <mode>, <hide>, sampleNum, delta; nothing is twosided
}

TEST_F(MitsubaData, TireFairylights) {
  if (!fs::exists(scenes("tire-fairylights"))) GTEST_SKIP();
  const Scene scene = read(scenes("tire-fairylights"));
  EXPECT_EQ(triangleCount(scene), 56787u);
  EXPECT_EQ(scene.emitters.size(), 5u);
  EXPECT_EQ(scene.cameras[0].spp, 512);
  ASSERT_EQ(messages(scene).size(), 1u);
  EXPECT_TRUE(contains(messages(scene)[0], "$integrator"));
}

TEST_F(MitsubaData, Staircase) {
  if (!fs::exists(scenes("staircase2"))) GTEST_SKIP();
  const Scene scene = read(scenes("staircase2"));
  EXPECT_EQ(scene.emitters.size(), 13u);
  ASSERT_EQ(messages(scene).size(), 1u);
  EXPECT_TRUE(contains(messages(scene)[0], "participating media"));
}

}  // namespace
}  // namespace lobelia
