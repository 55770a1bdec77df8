// `render --gather sglc` as a user types it.
#include "app/render_test.h"
#include "lobelia/film/metrics.h"

namespace lobelia {
namespace {

using CutsRender = test::RenderTest;

TEST_F(CutsRender, LargerCutsComeNearerToAllLights) {
  scene_ = kMicrofacets;
  const std::string base =
      "--lights vsl --size 64x48 --spp 1 --num-lights 6000 --component indirect --seed 2 ";
  const Film all = render(base, "all");
  double before = 1;
  for (const int nodes : {100, 400, 1600}) {
    const std::string name = std::to_string(nodes);
    const Film cut = render(base + "--gather sglc --sglc-mode unbiased --cut-size " + name, name);
    const double error = compare(cut, all).l2;
    EXPECT_LT(error, 0.75 * before) << nodes;
    EXPECT_NEAR(compare(cut, all).meanRatio, 1, 0.04) << nodes;
    before = error;
    const nlohmann::json stats = statistics(name);
    EXPECT_EQ(stats["gather"]["strategy"], "sglc");
    EXPECT_EQ(stats["gather"]["mode"], "unbiased");
    EXPECT_GT(stats["counts"]["pixels_per_pixel_node"], 8);
    EXPECT_GT(stats["counts"]["node_pairs_visited"], 0);
    EXPECT_NEAR(stats["counts"]["lights_per_light_node"].get<double>() * nodes,
                stats["lights"]["spherical"].get<double>(), 0.2 * 6000);
    EXPECT_GT(stats["seconds"]["trees"], 0);
    EXPECT_GT(stats["seconds"]["traverse"], 0);
  }
  EXPECT_LT(before, 0.05);
  EXPECT_FALSE(statistics("1600")["gather"].contains("clusters_missing_error"));
  const Film aimed = render(base + "--gather sglc --error 0.1", "aimed");
  EXPECT_LT(compare(aimed, all).l2, 0.2);
  const auto nodes = [&](const char* name) {
    return statistics(name)["counts"]["cut_nodes_per_pixel"].get<double>();
  };
  EXPECT_LT(2 * nodes("aimed"), nodes("1600"));
  // Four samples may each have twice the error.
  const std::string coarse =
      "--lights vsl --size 64x48 --num-lights 6000 --component indirect --seed 2 --passes 1 "
      "--gather sglc ";
  render(coarse + "--spp 1 --error 0.2", "one");
  render(coarse + "--spp 4 --error 0.1", "four");
  EXPECT_NEAR(nodes("four") / 4, nodes("one"), 0.1 * nodes("one"));
  EXPECT_LE(statistics("aimed")["gather"]["clusters_missing_error"], 0.1);
}

TEST_F(CutsRender, AnErrorThatIsMissedIsSaid) {
  const std::string base =
      "render box --detail 0.2 --size 32x24 --spp 1 --num-lights 5000 --gather sglc --error 0.001 "
      "-o " +
      (folder_ / "a.exr");
  const test::ProgramResult r = test::runProgram(base + " --cut-size 64");
  EXPECT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(r.err.find("--error 0.001 is missed by"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("64 nodes"), std::string::npos) << r.err;
  EXPECT_EQ(test::runProgram(base + " --cut-size 64 --error 0.9").err.find("is missed by"),
            std::string::npos);
}

TEST_F(CutsRender, SharedRaysAreFew) {
  const std::string base =
      "--lights glossy --clamp 1 --size 640x480 --crop 240,180,400,300 --spp 1 --num-lights 3000 "
      "--component indirect "
      "--gather sglc --cut-size 300 ";
  const Film own = render(base + "--sglc-mode unbiased", "own"), shared = render(base, "shared");
  EXPECT_EQ(statistics("shared")["gather"]["mode"], "shared");
  EXPECT_LT(2 * statistics("shared")["counts"]["rays_per_pixel"].get<double>(),
            statistics("own")["counts"]["rays_per_pixel"].get<double>());
  EXPECT_LT(compare(shared, own).l2, 0.12) << "shadows blur over a few pixels";
  EXPECT_NEAR(compare(shared, own).meanRatio, 1, 0.02);
}

// What is made of a picture's parts is what the picture has there, and the options that choose them
// go with every gather.
TEST_F(CutsRender, GoesWithOtherOptions) {
  const std::string base = "--size 48x40 --spp 3 --num-lights 300 --clamp 1 --gather ";
  for (const char* part :
       {"--crop 10,8,40,32 --max-depth 3", "--pixels 300 --passes 2 --lights vpl",
        "--direct lights --aov groups,types,cost"}) {
    SCOPED_TRACE(part);
    const Film all = render(base + "all " + part, "all");
    const Film cut = render(base + "sglc --cut-size 2000 --sglc-mode unbiased " + part, "cut");
    EXPECT_EQ(cut.alpha, all.alpha);
    EXPECT_LT(compare(cut, all).l2, 1e-4) << "all lights are in the cut";
  }
}

TEST_F(CutsRender, PairsComeNearerByTheirThreshold) {
  const std::string base =
      "--lights glossy --clamp 1 --size 64x48 --spp 1 --num-lights 3000 --component indirect ";
  const Film all = render(base, "all");
  const std::string paper = base + "--gather sglc --sglc-mode paper ";
  double before = 1, rays = 0;
  for (const char* threshold : {"0.1", "0.003"}) {
    const Film some = render(paper + "--threshold " + threshold, "some");
    const double error = compare(some, all).l2;
    EXPECT_LT(error, 0.8 * before) << threshold;
    EXPECT_NEAR(compare(some, all).meanRatio, 1, 0.05) << threshold;
    before = error;
    const nlohmann::json stats = statistics("some");
    EXPECT_EQ(stats["gather"]["mode"], "paper");
    EXPECT_EQ(stats["gather"]["bound"], "approximate");
    EXPECT_EQ(stats["gather"]["threshold"].get<double>(), std::stod(threshold));
    EXPECT_FALSE(stats["gather"].contains("cut_size"));
    EXPECT_GT(stats["counts"]["rays_per_pixel"], rays);
    EXPECT_GT(stats["counts"]["lights_per_light_node"], 1);
    EXPECT_GT(stats["counts"]["pixels_per_pixel_node"], 1);
    EXPECT_GT(stats["counts"]["node_pairs_visited"], 0);
    rays = stats["counts"]["rays_per_pixel"];
  }
  EXPECT_LT(before, 0.04);
  render(paper + "--bound conservative --threshold 0.003", "some");
  EXPECT_EQ(statistics("some")["gather"]["bound"], "conservative");
  EXPECT_GT(statistics("some")["counts"]["rays_per_pixel"], rays);
}

// At threshold 0 all lights are gathered, whatever picture is made of them.
TEST_F(CutsRender, PairsGoWithOtherOptions) {
  const std::string base = "--size 32x24 --spp 2 --num-lights 200 --clamp 1 --gather ";
  for (const char* part : {"--pixels 200 --max-depth 3 --crop 4,4,30,20",
                           "--direct lights --passes 2 --aov groups,types,cost"}) {
    SCOPED_TRACE(part);
    const Film all = render(base + "all " + part, "all");
    const Film some = render(base + "sglc --sglc-mode paper --threshold 0 " + part, "some");
    EXPECT_EQ(some.alpha, all.alpha);
    EXPECT_LT(compare(some, all).l2, 1e-4);
  }
}

TEST_F(CutsRender, WrongUseSaysWhatWouldBeRight) {
  expectError("--threshold 0.1", "--gather sglc");
  expectError("--gather sglc --threshold 0.1", "--sglc-mode paper");
  expectError("--gather sglc --sglc-mode shared --sglc-share radiance", "--sglc-mode paper");
  expectError("--gather sglc --sglc-mode paper --cut-size 9", "--sglc-mode shared or unbiased");
  expectError("--gather sglc --sglc-mode paper --bound tight", "conservative");
  expectError("--gather sglc --sglc-mode paper --error 0.1", "--sglc-mode shared or unbiased");
  expectError("--gather lightcuts --error 0.1", "--gather mrcs, sglc");
  expectError("--cut-size 10", "--gather sglc");
  expectError("--gather mrcs --sglc-mode shared", "--gather sglc");
  expectError("--gather sglc --sglc-mode papr", "shared");
  expectError("--gather sglc --cut-size 0", "--cut-size");
  expectError("--gather sglc --columns 10", "--gather mrcs");
  expectError("--lights path --gather sglc", "--lights path");
}

}  // namespace
}  // namespace lobelia
