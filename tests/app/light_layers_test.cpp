// --aov groups, types and cost; relight and show, as a user has them.
#include <gtest/gtest.h>

#include "lobelia/io/image_io.h"
#include "support/run_program.h"

namespace lobelia {
namespace {

using test::runProgram;
using test::TemporaryFolder;

// A glossy floor and a wall (of a kind whose lobes take no fits: most of a run is its start) under
// a panel, a point, a sky and a sun of different groups.
std::string stageWith(const std::string& emitters) {
  return R"(<scene version="3.0.0"><integrator type="path"><integer name="max_depth"
value="6"/></integrator><sensor type="perspective"><float name="fov" value="60"/>
<transform name="to_world"><lookat origin="0,2,6" target="0,0.5,0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="16"/></film>
</sensor><bsdf type="phong" id="floor"><float name="exponent" value="50"/></bsdf>
<bsdf type="phong" id="wall"><float name="exponent" value="20"/></bsdf>
<shape type="rectangle"><transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/>
</transform><ref id="floor"/></shape>
<shape type="rectangle"><transform name="to_world"><scale value="3"/><translate z="-3"/></transform>
<ref id="wall"/></shape>
)" + emitters +
         "</scene>";
}

std::string sceneText(bool panel, bool others) {
  std::string text;
  if (panel) {
    text += R"(<shape type="rectangle"><transform name="to_world"><scale value="0.5"/>
<rotate x="1" angle="90"/><translate y="2.5"/></transform><emitter type="area"><rgb name="radiance"
value="5,4,3"/><string name="group" value="ceiling panel"/></emitter></shape>)";
  }
  if (others) {
    text += R"(<emitter type="point"><point name="position" x="1" y="1" z="1"/>
<rgb name="intensity" value="1,2,1"/><string name="group" value="bulb"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.1,0.1,0.3"/></emitter>)";
  }
  return stageWith(text);
}

// Lights from afar, each of a group of its own.
const std::vector<std::pair<std::string, std::string>>& distantLights() {
  static const std::vector<std::pair<std::string, std::string>> lights{
      {"morning", R"(<emitter type="sun"><rgb name="irradiance" value="3,2,1"/><vector
name="direction" value="0.4,-1,-0.8"/><float name="angular_radius" value="3"/>
<string name="group" value="morning"/></emitter>)"},
      {"evening", R"(<emitter type="sun"><rgb name="irradiance" value="1,0.5,2"/><vector
name="direction" value="-0.9,-0.5,-0.4"/><string name="group" value="evening"/></emitter>)"},
      {"noon", R"(<emitter type="directional"><rgb name="irradiance" value="0.5,1,0.5"/><vector
name="direction" value="0.1,-1,-0.1"/><string name="group" value="noon"/></emitter>)"},
      {"clouds", R"(<emitter type="envmap"><string name="filename" value="clouds.png"/>
<string name="group" value="clouds"/></emitter>)"}};
  return lights;
}

double difference(const Film& film, const std::vector<std::string>& layers,
                  const std::string& whole) {
  double worst = 0;
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    Rgb sum{};
    for (const std::string& name : layers) sum += film.rgb(i, name);
    const Rgb w = film.rgb(i, whole);
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(double{sum[c]} - double{w[c]}) / (double{w[c]} + 1e-3));
  }
  return worst;
}

double meanOf(const Film& film, const std::string& layer) {
  double sum = 0;
  for (size_t i = 0; i < film.pixelCount(); ++i)
    sum += double{luminance(film.rgb(i, layer))} / static_cast<double>(film.pixelCount());
  return sum;
}

class LightLayers : public testing::Test {
 protected:
  void SetUp() override {
    test::writeText(folder_ / "all.xml", sceneText(true, true));
    test::writeText(folder_ / "panel.xml", sceneText(true, false));
  }
  Film render(const std::string& scene, const std::string& options) {
    const std::string out = folder_ / "out.exr";
    const auto r = runProgram("render " + (folder_ / scene) + " --quiet " + options + " -o " + out);
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return io::readFilm(out);
  }
  TemporaryFolder folder_;
  const std::vector<std::string> groups_{"group.default", "group.bulb", "group.ceiling panel"};
};

TEST_F(LightLayers, GroupsSumToThePictureOfEveryMethod) {
  for (const std::string method :
       {"--lights path --spp 4", "--lights light --spp 4", "--lights vpl --spp 2",
        "--lights glossy --spp 2", "--lights glossy --spp 2 --direct lights --env-lights 32",
        "--lights path --spp 4 --component indirect", "--lights glossy --spp 2 --component direct",
        "--lights vpl --spp 2 --compensate", "--lights vpl --spp 2 --near-lights 20",
        "--lights glossy --spp 2 --near-lights 20 --direct lights", "--lights photon --spp 2"}) {
    const Film film = render("all.xml", method + " --num-lights 64 --aov groups");
    EXPECT_LT(difference(film, groups_, ""), 1e-4) << method;
    for (const std::string& group : groups_)
      EXPECT_GT(meanOf(film, group), 0) << method << " " << group;
    const Film plain = render("all.xml", method + " --num-lights 64 --threads 1");
    EXPECT_EQ(film.layers.at("").values, plain.layers.at("").values) << method;
  }
}

TEST_F(LightLayers, AGroupIsThePictureOfItsLightsAlone) {
  for (const std::string method : {"--lights path --spp 64", "--lights light --spp 128",
                                   "--lights glossy --spp 16 --num-lights 128",
                                   "--lights vpl --spp 64 --num-lights 128 --compensate",
                                   "--lights photon --spp 16 --num-lights 20000"}) {
    const Film all = render("all.xml", method + " --aov groups");
    const Film alone = render("panel.xml", method);
    const double expected = meanOf(alone, "");
    EXPECT_NEAR(meanOf(all, "group.ceiling panel"), expected, 0.05 * expected) << method;
  }
}

// Suns and environments become directional lights of several groups, or are sampled as such.
TEST_F(LightLayers, DistantLightsOfSeveralGroups) {
  std::vector<uint8_t> clouds;
  for (int i = 0; i < 16 * 8; ++i)
    for (const int value : {60 + i, 90 + i / 2, 200 - i})
      clouds.push_back(static_cast<uint8_t>(value));
  io::writePng(folder_ / "clouds.png", clouds, 16, 8);
  std::string all;
  std::vector<std::string> layers;
  for (const auto& [group, text] : distantLights()) {
    all += text;
    layers.push_back("group." + group);
    test::writeText(folder_ / (group + ".xml"), stageWith(text));
  }
  test::writeText(folder_ / "distant.xml", stageWith(all));
  for (const std::string method :
       {"--lights path --spp 64", "--lights light --spp 128", "--lights glossy --spp 16",
        "--lights glossy --direct lights --env-lights 64 --spp 16"}) {
    const Film film = render("distant.xml", method + " --aov groups");
    EXPECT_LT(difference(film, layers, ""), 1e-4) << method;
    for (const auto& [group, text] : distantLights()) {
      const double alone = meanOf(render(group + ".xml", method), "");
      EXPECT_GT(alone, 0.01) << method << " " << group;
      EXPECT_NEAR(meanOf(film, "group." + group), alone, 0.05 * alone) << method << " " << group;
    }
  }
}

TEST_F(LightLayers, SavedLightsKeepTheirGroups) {
  const std::string lights = folder_ / "lights.dat";
  const std::string options = "--spp 1 --num-lights 64 --aov groups ";
  const Film made = render("all.xml", options + "--save-lights " + lights);
  const Film loaded = render("all.xml", options + "--load-lights " + lights);
  for (const std::string& group : groups_)
    EXPECT_EQ(made.layers.at(group).values, loaded.layers.at(group).values) << group;
}

// With the names of two groups swapped, the layers of an earlier run are no longer the right ones.
TEST_F(LightLayers, StateOfOtherGroupsIsRefused) {
  std::string text = sceneText(true, true);
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("value=\"bulb\"", "value=\"swapped\"");
  replace("value=\"ceiling panel\"", "value=\"bulb\"");
  replace("value=\"swapped\"", "value=\"ceiling panel\"");
  test::writeText(folder_ / "swapped.xml", text);
  const std::string lights = folder_ / "lights.dat", checkpoint = folder_ / "checkpoint";
  const std::string options = "--spp 1 --num-lights 64 --aov groups ";
  render("all.xml", options + "--save-lights " + lights);
  render("all.xml", options + "--checkpoint " + checkpoint);
  for (const std::string& state : {"--load-lights " + lights, "--resume " + checkpoint}) {
    const auto r = runProgram("render " + (folder_ / "swapped.xml") + " --quiet " + options +
                              state + " -o " + (folder_ / "out.exr"));
    EXPECT_EQ(r.exitCode, 3) << state << "\n" << r.err;
    EXPECT_NE(r.err.find("another scene"), std::string::npos) << state << "\n" << r.err;
  }
}

TEST_F(LightLayers, TypesSumToWhatWasGathered) {
  const Film film = render(
      "all.xml", "--direct lights --env-lights 32 --spp 2 --num-lights 64 --aov types,groups,cost");
  const std::vector<std::string> types{"od", "os", "nd", "ns", "dd", "ds", "sd", "ss"};
  double sum = 0;
  for (const std::string& type : types) {
    EXPECT_GT(meanOf(film, type), 0) << type;
    sum += meanOf(film, type);
  }
  EXPECT_LT(sum, meanOf(film, "") * 1.0001);  // emission that the eye sees is no light's
  EXPECT_GT(meanOf(film, "cost"), 10);
  EXPECT_EQ(runProgram("render " + (folder_ / "all.xml") + " --lights path --aov types -o " +
                       (folder_ / "x.exr"))
                .exitCode,
            2);
  // Without direct lights (of near receivers, too), emission and connections the indirect layer is
  // the sum.
  const Film indirect = render("all.xml",
                               "--spp 2 --num-lights 64 --specular-limit 0 --component indirect "
                               "--near-lights 0 "
                               "--aov types,indirect,specular");
  std::vector<std::string> parts = types;
  parts.push_back("specular");
  EXPECT_LT(difference(indirect, parts, "indirect"), 1e-4);
}

TEST_F(LightLayers, TypesOfSphericalLights) {
  const std::vector<std::string> parts{"vd", "vs", "specular"};
  for (const char* gather : {"all", "mrcs", "sglc", "sglc --sglc-mode paper", "lightslice",
                             "lightcuts", "mdlc --passes 1", "stochastic", "illumcut"}) {
    SCOPED_TRACE(gather);
    const Film film =
        render("all.xml",
               "--lights vsl --spp 2 --num-lights 500 --specular-limit 0 --component "
               "indirect --near-lights 0 --aov types,groups,indirect,specular,cost --gather " +
                   std::string(gather));
    EXPECT_GT(meanOf(film, "vd"), 0);
    EXPECT_GT(meanOf(film, "vs"), 0);
    EXPECT_EQ(meanOf(film, "dd"), 0);
    EXPECT_LT(difference(film, parts, "indirect"), 1e-4);
  }
  EXPECT_EQ(runProgram("render " + (folder_ / "all.xml") + " --lights vsl --vsl-sampling paper " +
                       "--aov types -o " + (folder_ / "x.exr"))
                .exitCode,
            2);
}

TEST_F(LightLayers, CostOfAPathTracerIsItsRays) {
  const Film film = render("all.xml", "--lights path --spp 4 --aov cost");
  EXPECT_EQ(film.layers.at("cost").channels, 1);
  EXPECT_GT(meanOf(film, "cost"), 2);
}

TEST_F(LightLayers, RelightMixesGroupsAndShowPaintsLayers) {
  const Film film = render("all.xml", "--lights path --spp 4 --aov groups,cost,variance");
  const std::string in = folder_ / "out.exr", out = folder_ / "mixed.exr";
  const auto r =
      runProgram("relight " + in + " --group bulb=0 --group 'ceiling panel=2,1,0.5,0' -o " + out);
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Film mixed = io::readFilm(out);
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const Rgb expected =
        film.rgb(i, "group.default") + film.rgb(i, "group.ceiling panel") * Rgb(2.f, 1.f, 0.f);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(mixed.rgb(i)[c], expected[c], 1e-5f * expected[c]);
  }
  EXPECT_LT(difference(mixed, groups_, ""), 1e-6);
  EXPECT_FALSE(mixed.layers.contains("variance"));
  EXPECT_EQ(runProgram("relight " + in + " --group blub=1 -o " + out).exitCode, 2);
  EXPECT_EQ(runProgram("relight " + in + " --group bulb=x -o " + out).exitCode, 2);
  EXPECT_EQ(runProgram("relight " + in + " --group bulb=-1 -o " + out).exitCode, 2);
  const auto shown =
      runProgram("show " + in + " --layer cost --false-colour -o " + (folder_ / "heat.png"));
  EXPECT_EQ(shown.exitCode, 0) << shown.err;
  EXPECT_NE(shown.out.find("white"), std::string::npos);
  EXPECT_EQ(runProgram("show " + in + " --layer coast -o " + (folder_ / "h.png")).exitCode, 2);
}

}  // namespace
}  // namespace lobelia
