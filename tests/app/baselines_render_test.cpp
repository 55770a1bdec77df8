// `render --gather lightslice`, `lightcuts`, `mdlc`, `stochastic` and `illumcut` and `--lights
// richvpl` as a user types them.
#include "app/render_test.h"
#include "lobelia/film/metrics.h"

namespace lobelia {
namespace {

using BaselinesRender = test::RenderTest;

const std::string kBase =
    "--clamp 0.3 --size 32x24 --spp 1 --num-lights 1500 --component indirect --seed 2 ";

TEST_F(BaselinesRender, LightSlice) {
  scene_ = kMicrofacets;
  const Film all = render(kBase, "all");
  double before = 0.03;
  for (const int columns : {30, 120, 480}) {
    const std::string name = std::to_string(columns);
    const Film film = render(kBase + "--gather lightslice --slices 40 --columns " + name, name);
    // Not by squares: a light that the row of a slice hardly sees flares up, one seed in ten.
    const double error = compare(film, all).mae;
    EXPECT_LT(error, 0.7 * before) << columns;
    EXPECT_NEAR(compare(film, all).meanRatio, 1, 0.12) << columns;
    before = error;
    const nlohmann::json stats = statistics(name);
    EXPECT_EQ(stats["gather"]["slices"], 40);
    EXPECT_EQ(stats["gather"]["columns"], columns);
    EXPECT_GT(stats["seconds"]["rows"], 0);
    EXPECT_GT(stats["seconds"]["cluster"], 0);
    EXPECT_NEAR(stats["counts"]["cut_nodes_per_pixel"], 40.0 * columns / (32 * 24),
                0.2 * columns * 40 / (32 * 24));
  }
}

TEST_F(BaselinesRender, Lightcuts) {
  const Film all = render(kBase, "all");
  double before = 1;
  for (const std::string threshold : {"0.2", "0.05", "0.01"}) {
    const Film film =
        render(kBase + "--gather lightcuts --cut-size 3000 --threshold " + threshold, threshold);
    const double error = compare(film, all).l2;
    EXPECT_LT(error, 0.75 * before) << threshold;
    before = error;
    const nlohmann::json stats = statistics(threshold);
    EXPECT_EQ(stats["gather"]["threshold"].get<double>(), std::stod(threshold));
    EXPECT_EQ(stats["gather"]["cut_size"], 3000);
    EXPECT_GT(stats["counts"]["node_pairs_visited"], 0);
    EXPECT_GT(stats["seconds"]["trees"], 0);
    EXPECT_LT(stats["counts"]["cut_nodes_per_pixel"],
              stats["lights"]["diffuse"].get<double>() + stats["lights"]["glossy"].get<double>());
  }
  EXPECT_LT(before, 0.03);
}

TEST_F(BaselinesRender, StochasticLightcuts) {
  const Film all = render(kBase, "all");
  double before = 1;
  for (const int nodes : {40, 160, 640}) {
    const std::string name = std::to_string(nodes);
    const Film film = render(kBase + "--gather stochastic --cut-size " + name, name);
    const double error = compare(film, all).l2;
    EXPECT_LT(error, 0.75 * before) << nodes;
    EXPECT_NEAR(compare(film, all).meanRatio, 1, 0.05) << nodes;
    before = error;
    EXPECT_LE(statistics(name)["counts"]["cut_nodes_per_pixel"], 1.2 * nodes)
        << "some pixels have more than one receiver";
  }
}

TEST_F(BaselinesRender, IlluminationCut) {
  const Film all = render(kBase, "all");
  double before = 0.5;
  for (const std::string threshold : {"0.2", "0.05", "0.01"}) {
    const Film film = render(kBase + "--gather illumcut --threshold " + threshold, threshold);
    const double error = compare(film, all).l2;
    EXPECT_LT(error, 0.75 * before) << threshold;
    before = error;
    const nlohmann::json stats = statistics(threshold);
    EXPECT_EQ(stats["gather"]["threshold"].get<double>(), std::stod(threshold));
    EXPECT_FALSE(stats["gather"].contains("cut_size"));
    EXPECT_GT(stats["counts"]["node_pairs_visited"], 0);
    EXPECT_GT(stats["counts"]["lights_per_light_node"], 1);
    EXPECT_GT(stats["counts"]["pixels_per_pixel_node"], 1);
    EXPECT_GT(stats["seconds"]["trees"], 0);
  }
  EXPECT_LT(before, 0.05);
  const Film full = render(kBase + "--gather illumcut --illumcut-rays full", "full");
  EXPECT_GT(statistics("full")["counts"]["shadow_rays"],
            statistics("0.01")["counts"]["shadow_rays"]);
  EXPECT_LT(compare(full, all).l2, 1.1 * before);
}

// Tails of sharp lobes and places with next to no light are no error.
TEST_F(BaselinesRender, RichVplsOfFaintLightAreFinite) {
  for (const std::string scene : {"box", "kitchen"})
    for (const std::string form : {"cube", "vmf"}) {
      const std::string file = folder_ / (scene + form);
      const test::ProgramResult r = test::runProgram(
          "render " + scene + " --detail 0.2 --size 32x24 --spp 1 --quiet --lights richvpl " +
          "--richvpl-radiance " + form + " -o " + file + ".exr --stats " + file + ".json");
      ASSERT_EQ(r.exitCode, 0) << r.err;
      EXPECT_EQ(statistics(scene + form)["counts"]["nonfinite"], 0) << scene << " " << form;
    }
}

TEST_F(BaselinesRender, RichVpls) {
  scene_ = kMicrofacets;
  const Film all = render(kBase + "--near-lights 0", "all");
  for (const std::string form : {"cube --richvpl-texels 32", "vmf"}) {
    double before = 0.05;
    for (const int lights : {60, 300, 1400}) {
      const std::string name = std::to_string(lights);
      const Film film = render(
          kBase + "--lights richvpl --richvpl-lights " + name + " --richvpl-radiance " + form,
          name);
      const double error = compare(film, all).relmse;
      EXPECT_LT(error, 0.6 * before) << form << " " << lights;
      EXPECT_NEAR(compare(film, all).meanRatio, 1, 0.12) << form << " " << lights;
      before = error;
      const nlohmann::json stats = statistics(name);
      EXPECT_EQ(stats["gather"]["strategy"], "all");
      EXPECT_EQ(stats["lights"]["model"], "richvpl");
      EXPECT_EQ(stats["lights"]["rich_lights"], lights) << form;
      EXPECT_EQ(stats["lights"]["radiance"], form.substr(0, form.find(' ')));
      EXPECT_GT(stats["lights"]["bytes_per_rich_light"], form == "vmf" ? 200 : 18000);
      EXPECT_GT(stats["seconds"]["rows"], 0);
      EXPECT_GT(stats["counts"]["shadow_rays"], 0);
    }
    EXPECT_LT(before, 0.002) << form;
  }
}

// Samples share cuts: four of them take hardly more rays than one.
TEST_F(BaselinesRender, MultidimensionalLightcuts) {
  const std::string start =
      "--lights glossy --clamp 0.3 --size 16x12 --num-lights 1500 --component indirect --seed 2 ";
  const std::string base = start + "--spp 4 --passes 1 ";
  const Film all = render(base, "all");
  double before = 1;
  for (const std::string threshold : {"0.2", "0.05", "0.01"}) {
    const Film film =
        render(base + "--gather mdlc --cut-size 10000 --threshold " + threshold, threshold);
    const double error = compare(film, all).l2;
    EXPECT_LT(error, 0.75 * before) << threshold;
    before = error;
    const nlohmann::json stats = statistics(threshold);
    EXPECT_EQ(stats["gather"]["threshold"].get<double>(), std::stod(threshold));
    EXPECT_EQ(stats["gather"]["cut_size"], 10000);
    EXPECT_GT(stats["counts"]["pixels_per_pixel_node"], 1);
  }
  EXPECT_LT(before, 0.05);
  render(start + "--spp 1 --gather mdlc --cut-size 10000 --threshold 0.01", "one");
  EXPECT_LT(statistics("0.01")["counts"]["shadow_rays"].get<double>(),
            2 * statistics("one")["counts"]["shadow_rays"].get<double>());
}

TEST_F(BaselinesRender, MultidimensionalLightcutsHaveASetOfLightsForManySamples) {
  const std::string base = "--size 8x6 --num-lights 20 --quiet --aov variance --gather ";
  const Film shared = render(base + "mdlc --spp 18", "shared");
  EXPECT_EQ(statistics("shared")["lights"]["sets"], 2);
  const Film own = render(base + "lightcuts --spp 18", "own");
  EXPECT_EQ(statistics("own")["lights"]["sets"], 18);
  // Of two values, it is still a variance of the mean.
  double sharedSum = 0, ownSum = 0;
  for (const float v : shared.layers.at("variance").values) sharedSum += double{v};
  for (const float v : own.layers.at("variance").values) ownSum += double{v};
  EXPECT_GT(sharedSum, 0.02 * ownSum);
  EXPECT_LT(sharedSum, 50 * ownSum);
}

// Without a threshold all lights are in the cut, and the options that choose parts of a picture go
// with every gather.
TEST_F(BaselinesRender, GoWithOtherOptions) {
  const std::string base = "--size 8x6 --spp 2 --num-lights 100 --clamp 1 --gather ";
  const std::string lightcuts = "lightcuts --threshold 0 --cut-size 3000";
  const std::string stochastic = "stochastic --cut-size 3000", slices = "lightslice --columns 3000";
  const std::string near = " --near-lights 0";  // which places do not combine with
  const std::string rich = "all --lights richvpl --richvpl-lights 3000";  // a place for each light
  const std::string whole = "illumcut --threshold 0", mdlc = "mdlc --threshold 0 --cut-size 9000";
  for (const auto& [strategy, part] : std::initializer_list<std::pair<std::string, std::string>>{
           {lightcuts, "--crop 2,1,6,5"},
           {slices, "--pixels 15"},
           {stochastic, "--passes 2"},
           {lightcuts, "--direct lights"},
           {stochastic, "--max-depth 3"},
           {slices, "--aov groups,types,cost"},
           {lightcuts, "--lights vpl"},
           {whole, "--crop 2,1,6,5"},
           {whole, "--direct lights --pixels 15"},
           {whole, "--max-depth 3"},
           {mdlc, "--passes 1 --crop 2,1,6,5"},
           {mdlc, "--passes 1 --pixels 15"},
           {mdlc, "--passes 2 --direct lights"},
           {mdlc, "--passes 1 --max-depth 3"},
           {mdlc, "--passes 1 --aov groups,types,cost"},
           {rich, "--crop 2,1,6,5" + near},
           {rich, "--pixels 15 --passes 2" + near},
           {rich, "--direct lights" + near},
           {rich, "--max-depth 3" + near},
           {rich, "--aov groups,types,cost" + near}}) {
    const Film all = render(base + "all " + part, "all"),
               some = render(base + strategy + " " + part, "some");
    EXPECT_EQ(some.alpha, all.alpha) << part;
    EXPECT_LT(compare(some, all).l2, 1e-4) << strategy << " " << part;
  }
}

TEST_F(BaselinesRender, WrongUseSaysWhatWouldBeRight) {
  expectError("--gather lightslice --rows 10", "--gather mrcs");
  expectError("--gather mrcs --slices 10", "--gather lightslice");
  expectError("--gather all --columns 10", "mrcs, lightslice");
  expectError("--gather mrcs --threshold 0.1", "sglc, lightcuts, mdlc, stochastic, illumcut");
  expectError("--gather illumcut --cut-size 10", "sglc, lightcuts, mdlc, stochastic");
  expectError("--gather mdlc --illumcut-rays full", "--gather illumcut");
  expectError("--gather illumcut --illumcut-rays half", "sampled");
  expectError("--gather illumcut --bound conservative", "sglc");
  expectError("--gather mdlc --columns 10", "mrcs, lightslice");
  expectError("--lights path --gather mdlc", "--lights path");
  expectError("--gather lightcuts --threshold 2", "--threshold");
  expectError("--gather lightslice --cut-size 10", "sglc, lightcuts, mdlc, stochastic");
  expectError("--gather lightcut", "lightcuts");
  expectError("--gather lightslice --num-lights 3000 --memory 1K", "--slices");
  expectError("--lights path --gather lightcuts", "--lights path");
  expectError("--lights richvpl --richvpl-radiance cubes", "cube");
  expectError("--lights richvpl --richvpl-texels 8", "--richvpl-radiance cube");
  expectError("--lights richvpl --richvpl-radiance cube --richvpl-lobes 8", "--richvpl-texels");
  expectError("--lights richvpl --richvpl-radiance cube --richvpl-texels 9", "10 is needed");
  expectError("--lights richvpl --richvpl-lobes 0", "--richvpl-lobes");
  expectError("--lights richvpl --columns 10", "mrcs, lightslice");
  expectError("--lights richvpl --gather sglc",
              "--lights richvpl does not combine with --gather sglc; it does with all");
  expectError("--lights richvpl --compensate", "vpl and glossy");
  expectError("--lights richvpl --near-lights 10", "vpl, glossy and vsl");
  expectError("--compensate --near-lights 10", "leave out one");
  expectError("--near-lights -1", "--near-lights");
  expectError("--gather richvpl", "'richvpl' is not known");
  expectError("--lights richvpl --num-lights 3000 --memory 1K", "--richvpl-lights");
}

}  // namespace
}  // namespace lobelia
