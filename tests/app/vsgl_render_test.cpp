// `render --lights vsgl` as a user types it.
#include <cmath>

#include "app/render_test.h"
#include "lobelia/film/metrics.h"

namespace lobelia {
namespace {

class VsglRender : public test::RenderTest {};

TEST_F(VsglRender, ComesNearerToThePathTracerWithMoreLights) {
  const std::string base = "--size 32x26 --component indirect --spp 16 ";
  const Film path =
      render("--size 32x26 --component indirect --lights path --spp 512 --seed 9", "p");
  double before = 1e9;
  for (const int lights : {4, 32, 256}) {
    const Film film =
        render(base + "--lights vsgl --passes 1 --num-lights " + std::to_string(lights),
               "v" + std::to_string(lights));
    const Comparison error = compare(film, path);
    EXPECT_LT(error.l2, before) << lights;
    before = error.l2;
    const nlohmann::json s = statistics("v" + std::to_string(lights));
    // Depths are rounded one by one.
    EXPECT_NEAR(s["lights"]["vsgl"].get<double>(), lights, 5);
    EXPECT_EQ(s["lights"]["glossy"], 0);
    EXPECT_EQ(s["counts"]["nonfinite"], 0);
    EXPECT_GT(s["counts"]["light_points"], 10000);
    EXPECT_NEAR(error.meanRatio, 1, lights == 256 ? 0.15 : 0.6);
  }
  EXPECT_LT(before, 0.26);
}

TEST_F(VsglRender, EveryWayOfClusteringGivesTheLight) {
  const std::string base = "--size 32x26 --component indirect --max-depth 3 ";
  const Film path = render(base + "--lights path --spp 512 --seed 9", "p");
  for (const char* clusters : {"tree", "kmeans", "fis", "fis-original"}) {
    const Film film = render(
        base + "--lights vsgl --spp 8 --num-lights 256 --vsgl-clusters " + clusters, clusters);
    const Comparison error = compare(film, path);
    EXPECT_LT(error.l2, 0.45) << clusters;
    EXPECT_NEAR(error.meanRatio, 1, std::string(clusters) == "fis-original" ? 0.3 : 0.2)
        << clusters;
  }
}

TEST_F(VsglRender, FormsAgreeRoughly) {
  const std::string base =
      "--size 32x24 --component indirect --spp 4 --lights vsgl --num-lights 128 ";
  const Film ours = render(base, "ours");
  for (const char* form : {"--vsgl-shading product --vsgl-merging toksvig",
                           "--vsgl-shading pulled --vsgl-merging toksvig",
                           "--vsgl-variance isotropic --vsgl-spread 1", "--vsgl-shadows random"}) {
    const Comparison error = compare(render(base + form, "form"), ours);
    EXPECT_GT(error.l2, 0.001) << form;  // it does something
    EXPECT_LT(error.l2, 0.35) << form;
    EXPECT_NEAR(error.meanRatio, 1, 0.15) << form;
  }
}

TEST_F(VsglRender, FewShadowRaysHaveTheMeanOfAll) {
  const std::string base =
      "--size 48x40 --component indirect --lights vsgl --num-lights 256 --passes 1 ";
  const Film all = render(base + "--spp 16", "all");
  const Film some = render(base + "--spp 16 --vsgl-shadows 8", "some");
  const Film none = render(base + "--spp 1 --vsgl-shadows none", "none");
  EXPECT_NEAR(compare(some, all).meanRatio, 1, 0.01);
  EXPECT_LT(compare(some, all).l2, 0.15);
  EXPECT_GT(compare(none, all).meanRatio, 1.02);
  EXPECT_LT(statistics("some")["counts"]["shadow_rays"].get<double>(),
            0.3 * statistics("all")["counts"]["shadow_rays"].get<double>());
  EXPECT_LT(statistics("none")["counts"]["rays_per_pixel"].get<double>(), 20);
}

TEST_F(VsglRender, ShadowMapsComeNearTheRays) {
  scene_ = kMicrofacets;
  const std::string base =
      "--size 48x40 --component indirect --spp 4 --lights vsgl --num-lights 256 --passes 1 ";
  const Film rays = render(base, "rays");
  const Film none = render(base + "--vsgl-shadows none", "none");
  double before = compare(none, rays).l2;
  for (const char* size : {"16", "64", "256"}) {
    const Comparison error =
        compare(render(base + "--vsgl-shadows maps --vsgl-map-size " + size, size), rays);
    EXPECT_LT(error.l2, before) << size;
    EXPECT_NEAR(error.meanRatio, 1, 0.03) << size;
    before = error.l2;
  }
  EXPECT_LT(before, 0.04);
}

TEST_F(VsglRender, PairsHaveTwoLightsForAnEmitter) {
  scene_ = kMicrofacets;
  const std::string base = "--size 48x40 --component indirect --max-depth 3 --spp ";
  const Film path = render(base + "512 --lights path", "p");
  const Film pairs =
      render(base + "4 --lights vsgl --vsgl-clusters pairs --vsgl-shadows none", "v");
  const double emitters = statistics("v")["scene"]["emitters"].get<double>();
  EXPECT_LE(statistics("v")["lights"]["vsgl"].get<double>(), 2 * emitters);
  EXPECT_GE(statistics("v")["lights"]["vsgl"].get<double>(), emitters);
  // Of all the light there is, unshadowed, as many lights have it.
  const Film many = render(base + "4 --lights vsgl --num-lights 256 --vsgl-shadows none", "m");
  EXPECT_NEAR(compare(pairs, many).meanRatio, 1, 0.25);
  EXPECT_LT(compare(pairs, many).l2, 0.6);
  EXPECT_LT(compare(pairs, path).l2, 1);
}

TEST_F(VsglRender, OtherStrategiesGatherTheSame) {
  const std::string base =
      "--size 32x26 --component indirect --spp 16 --lights vsgl --num-lights 512 --passes 1 ";
  const Film all = render(base, "all");
  for (const char* gather :
       {"sglc --sglc-mode unbiased --cut-size 256", "sglc --sglc-mode shared --cut-size 256",
        "sglc --sglc-mode paper", "mrcs --columns 400"}) {
    const Comparison error = compare(render(base + "--gather " + gather, "g"), all);
    EXPECT_LT(error.l2, 0.12) << gather;
    EXPECT_NEAR(error.meanRatio, 1, 0.02) << gather;
  }
}

// Deep light joins that of less depth.
TEST_F(VsglRender, TwoLightsAreTwo) {
  for (const char* clusters : {"tree", "fis"}) {
    const std::string options =
        "--size 16x12 --spp 1 --lights vsgl --num-lights 2 --vsgl-clusters ";
    render(options + clusters, clusters);
    EXPECT_LE(statistics(clusters)["lights"]["vsgl"], 3);
    EXPECT_GE(statistics(clusters)["lights"]["vsgl"], 1);
  }
}

TEST_F(VsglRender, EmittersAreLightsToo) {
  const std::string base = "--size 48x40 ";
  const Film nee = render(base + "--lights path --spp 256 --component direct", "nee");
  const Film lights = render(
      base + "--spp 16 --lights vsgl --num-lights 512 --direct lights --component direct", "l");
  EXPECT_NEAR(compare(lights, nee).meanRatio, 1, 0.03);
  EXPECT_LT(compare(lights, nee).l2, 0.15);
}

TEST_F(VsglRender, SavedLightsRenderTheSame) {
  const std::string file = folder_ / "lights";
  const std::string base = "--size 32x24 --spp 2 --lights vsgl --num-lights 64 --passes 1 ";
  const Film first = render(base + "--save-lights " + file, "a");
  const Film second = render(base + "--load-lights " + file, "b");
  EXPECT_EQ(first.layers.at("").values, second.layers.at("").values);
}

TEST_F(VsglRender, ThreadsDoNotMatter) {
  for (const char* more :
       {"--vsgl-clusters tree", "--vsgl-clusters fis --vsgl-shadows 4", "--vsgl-shadows maps",
        "--vsgl-clusters pairs", "--vsgl-clusters kmeans --gather sglc"}) {
    const std::string base =
        std::string("--size 32x24 --spp 2 --lights vsgl --num-lights 64 ") + more;
    EXPECT_EQ(render(base + " --threads 1", "one").layers.at("").values,
              render(base + " --threads 2", "two").layers.at("").values)
        << more;
  }
}

TEST_F(VsglRender, BadSettingsSayWhatIsRight) {
  expectError("--lights vsgl --gather lightcuts", "it does with all, mrcs, sglc");
  expectError("--lights vsgl --vsgl-clusters trees", "did you mean 'tree'");
  expectError("--lights vsgl --vsgl-views 4",
              "--vsgl-clusters kmeans, fis, fis-original and pairs");
  expectError("--lights vsgl --vsgl-map-size 64", "--vsgl-shadows maps");
  expectError("--lights vsgl --vsgl-shadows maps --vsgl-map-size 7", "from 8 to 1024");
  expectError("--lights vsgl --vsgl-shadows maps --gather mrcs", "--gather all");
  expectError("--lights vsgl --vsgl-shadows map", "did you mean 'maps'");
  expectError("--lights vsgl --vsgl-clusters kmeans --vsgl-overlap 2", "do not overlap");
  expectError("--lights vsgl --vsgl-shadows 0", "from 1 to 4096");
  expectError("--lights vsgl --vsgl-shadows 4 --gather sglc", "--gather all");
  expectError("--lights vsgl --vsgl-points 16777217", "from 1 to 16777216");
  expectError("--lights vsgl --vsgl-shadows 4 --aov groups", "--vsgl-shadows 4 traces some");
  expectError("--lights vsgl --vsgl-spread 0", "a finite number above 0");
  expectError("--lights vsgl --num-lights 0", "--num-lights");
  expectError("--lights vsgll", "vsgl");
}

}  // namespace
}  // namespace lobelia
