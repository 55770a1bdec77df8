// `lobelia view` on data of `lobelia precompute --method vmf`, as a user types it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/block_scene.h"
#include "app/command_line.h"
#include "lobelia/film/metrics.h"
#include "lobelia/io/image_io.h"

namespace lobelia::test {
namespace {

constexpr const char* kSun = R"(<scene version="3.0.0"><emitter type="directional">
  <vector name="direction" value="-0.4, -1, -0.3"/><rgb name="irradiance" value="2, 1.8, 1.5"/>
  </emitter></scene>)";

using Values = std::vector<float>;

class ViewTransfer : public testing::Test {
 protected:
  void SetUp() override {
    writeText(file("scene.xml"), kBlockScene);
    const ProgramResult r =
        runProgram("precompute " + file("scene.xml") +
                   " --method vmf --directions 162 --rays 4 --subdivide 2 --mask-level 4 "
                   "--mask-tolerance 0.1 --quiet -o " +
                   file("data"));
    ASSERT_EQ(r.exitCode, 0) << r.err;
  }
  std::string file(const std::string& name) const { return folder_ / name; }
  std::string command(const std::string& options, const std::string& name) const {
    return "view " + file("scene.xml") + " --data " + file("data") + " --headless " + options +
           " -o " + file(name);
  }
  Film film(const std::string& options) const {
    const ProgramResult r = runProgram(command("--quiet " + options, "view.exr"));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return io::readFilm(file("view.exr"));
  }
  Values view(const std::string& options) const { return film(options).layers.at("").values; }

  TemporaryFolder folder_;
};

TEST_F(ViewTransfer, IsThePathTracersPicture) {
  const ProgramResult r =
      runProgram("render " + file("scene.xml") +
                 " --lights path --max-depth 4 --spp 256 --quiet -o " + file("reference.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Comparison c = compare(film("--spp 16"), io::readFilm(file("reference.exr")));
  EXPECT_NEAR(c.meanRatio, 1, 0.02);
  EXPECT_LT(c.l2, 0.05);
}

TEST_F(ViewTransfer, BouncesAddUp) {
  const Values all = view(""), direct = view("--component direct"),
               indirect = view("--component indirect");
  EXPECT_EQ(view("--bounce 0"), direct);
  const Values first = view("--bounce 1"), second = view("--bounce 2");
  float most = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(direct[i] + indirect[i], all[i], 1e-4f + 1e-3f * all[i]);
    EXPECT_NEAR(first[i] + second[i], indirect[i], 1e-4f + 1e-3f * indirect[i]);
    most = std::max(most, second[i]);
  }
  EXPECT_GT(most, 0);
  EXPECT_EQ(indirect[0], 0) << "the sky, which is direct light";
  EXPECT_GT(direct[0], 0);
  writeText(file("script.txt"), "frame\nbounce 1\nframe\nbounce 0\nframe\nbounce all\nframe\n");
  const ProgramResult r =
      runProgram(command("--bounce 2 --script " + file("script.txt"), "s%d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Values* const shown[] = {&second, &first, &direct, &all};
  for (size_t i = 0; i < 4; ++i)
    EXPECT_EQ(io::readFilm(file("s" + std::to_string(i) + ".exr")).layers.at("").values, *shown[i])
        << i;
  expectFailure(command("--bounce 3", "x.exr"), 2, "0 to 2 bounces");
  expectFailure(command("--bounce 1 --component all", "x.exr"), 2, "--component");
}

TEST_F(ViewTransfer, FramesTurnTheLightAndSayWhatTheyCost) {
  const std::string sun = "--design " + file("sun.xml") + " ";
  writeText(file("sun.xml"), kSun);
  const ProgramResult r = runProgram(
      command(sun + "--frames 3 --rotate-step 60 --stats " + file("stats.json"), "f%d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Values last = io::readFilm(file("f2.exr")).layers.at("").values;
  EXPECT_NE(io::readFilm(file("f0.exr")).layers.at("").values, last);
  EXPECT_EQ(last, view(sun + "--rotate 120"));
  EXPECT_EQ(last, view(sun + "--rotate 120 --threads 1"));
  const nlohmann::json stats = nlohmann::json::parse(readText(file("stats.json")));
  EXPECT_EQ(stats["gather"]["strategy"], "transfer");
  EXPECT_EQ(stats["transfer"]["directions"], 162);
  EXPECT_EQ(stats["transfer"]["passes"], 3);
  EXPECT_EQ(stats["counts"]["frames"], 3);
  EXPECT_GT(stats["counts"]["light_lookups_per_pixel"], 0);
  EXPECT_EQ(stats["counts"]["nonfinite"], 0);
  EXPECT_GT(stats["frames_per_second"], 0);
  for (const char* stage : {"prepare", "buffer", "merge", "shade"})
    EXPECT_GT(stats["seconds"][stage], 0) << stage;
  EXPECT_EQ(stats["gather"]["mode"], "");
  for (const char* key : {"light_cut", "vertices", "visibility_cut"})
    EXPECT_FALSE(stats["gather"].contains(key)) << key << " is of cuts";
  for (const char* key : {"merged_nodes_per_vertex", "evaluations_per_pixel", "mirror_rays"})
    EXPECT_FALSE(stats["counts"].contains(key)) << key << " is of cuts";
  for (const char* key : {"cut", "direct"})
    EXPECT_FALSE(stats["seconds"].contains(key)) << key << " is of cuts";
}

// Light changes at once; materials stay as they were precomputed, which is said once.
TEST_F(ViewTransfer, ScriptsChangeTheLightAlone) {
  writeText(file("sun.xml"), kSun);
  writeText(file("script.txt"),
            "frame\ndesign sun.xml\nframe\nmaterial paint alpha 0.05\nframe\nturn 30\n"
            "material paint alpha 0.1\nframe\nmethod path 2\nframe\nmethod transfer\nframe\n"
            "method cuts\n");
  const ProgramResult r = runProgram(command("--script " + file("script.txt"), "s%d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const auto values = [&](int frame) {
    return io::readFilm(file("s" + std::to_string(frame) + ".exr")).layers.at("").values;
  };
  EXPECT_EQ(values(0), view(""));
  EXPECT_NE(values(1), values(0));
  EXPECT_EQ(values(2), values(1));
  EXPECT_EQ(values(3), view("--rotate 30 --design " + file("sun.xml")));
  EXPECT_NE(values(4), values(3));
  EXPECT_EQ(values(5), values(3));
  const std::string said = "materials as they were when it was precomputed";
  const size_t at = r.err.find(said);
  EXPECT_NE(at, std::string::npos) << r.err;
  EXPECT_EQ(r.err.find(said, at + 1), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("script.txt:4: transfer shows"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("what was changed: 'paint'"), std::string::npos) << r.err;
}

TEST_F(ViewTransfer, TheFirstDataAreShown) {
  const ProgramResult made =
      runProgram("precompute " + file("scene.xml") +
                 " --method cuts --samples 512 --clusters 16 --quiet -o " + file("cuts"));
  ASSERT_EQ(made.exitCode, 0) << made.err;
  EXPECT_EQ(view("--data " + file("cuts")), view(""));
  const ProgramResult r = runProgram(command("--data " + file("cuts"), "x.exr"));
  EXPECT_NE(r.err.find("frames are by transfer"), std::string::npos) << r.err;
  writeText(file("script.txt"), "method cuts\nframe\n");
  const Values cuts = view("--data " + file("cuts") + " --script " + file("script.txt"));
  const ProgramResult other =
      runProgram("view " + file("scene.xml") + " --headless --data " + file("cuts") + " --data " +
                 file("data") + " -o " + file("y.exr"));
  EXPECT_NE(other.err.find("frames are by cuts"), std::string::npos) << other.err;
  EXPECT_EQ(io::readFilm(file("y.exr")).layers.at("").values, cuts);
  const std::string cutsFirst = "view " + file("scene.xml") + " --headless --data " + file("cuts") +
                                " --data " + file("data") + " -o " + file("y.exr") + " --bounce 1";
  expectFailure(cutsFirst, 2, "frames are by cuts");
  writeText(file("script.txt"), "method transfer\nframe\n");
  EXPECT_EQ(runProgram(cutsFirst + " --quiet --script " + file("script.txt")).exitCode, 0);
  EXPECT_EQ(io::readFilm(file("y.exr")).layers.at("").values, view("--bounce 1"));
}

TEST_F(ViewTransfer, RefusesWhatItCannotDraw) {
  expectFailure(command("--data " + file("data"), "x.exr"), 2, "second file of --method vmf");
  const auto failing = [&](const std::string& script, const std::string& said) {
    writeText(file("script.txt"), script);
    expectFailure(command("--script " + file("script.txt"), "x.exr"), 3, said);
  };
  failing("method cuts\nframe\n", "no data of visibility");
  failing("frame\nfalse-colour illuminance\nframe\n", "script.txt:3");
  failing("bounce some\nframe\n", "a number from 0, or all");
  failing("bounce 3\nframe\n", "script.txt:1: bounce 3: the data has light of 0 to 2");
  failing("method path 1\nbounce 1\nframe\n", "add a line before it: method transfer");
  const std::string part = "has light of bounce 1 alone, but a truth has all light";
  failing("bounce 1\nframe\ntruth 1\n", "script.txt:3: the picture " + part);
  for (const char* compared : {"split 0.5", "false-colour error"})
    failing(std::string("truth 1\nbounce 1\nframe\n") + compared + "\nscreenshot x.png\n", part);
  failing("false-colour cost\nframe\nscreenshot x.png\n", "transfer does not count");
  std::string scene = kBlockScene;
  scene.replace(scene.find("0.3\"/></bsdf>"), 3, "0.2");
  writeText(file("scene.xml"), scene);
  expectFailure(command("", "x.exr"), 3, "materials or textures were changed");
}

TEST_F(ViewTransfer, NamesTheDesignThatChangesMaterials) {
  writeText(file("shiny.xml"), R"(<scene version="3.0.0"><bsdf type="roughconductor" id="paint">
    <float name="alpha" value="0.1"/></bsdf></scene>)");
  const std::string design = " --design " + file("shiny.xml");
  expectFailure(command(design, "x.exr"), 3, file("shiny.xml") + ": this design changes materials");
  expectFailure(command(design, "x.exr"), 3, "('paint')");
  // What else is wrong is not the design's fault.
  std::string scene = kBlockScene;
  scene.replace(scene.find("0.6, 0.5, 0.4"), 3, "0.7");
  writeText(file("scene.xml"), scene);
  expectFailure(command(design, "x.exr"), 3, "materials or textures were changed");
}

TEST_F(ViewTransfer, SaysWhatItLeavesOut) {
  std::string scene = kBlockScene;
  const size_t from = scene.find("<emitter"), to = scene.find("</emitter>");
  scene.replace(from, to - from, R"(<emitter type="point"><point name="position" value="0, 3, 0"/>
    <rgb name="intensity" value="9"/>)");
  writeText(file("scene.xml"), scene);
  const ProgramResult r = runProgram(command("", "x.exr"));
  EXPECT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(r.err.find("no light from infinity"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("1 of 1 emitters are not at infinity"), std::string::npos) << r.err;
}

// How often it is said.
size_t timesSaid(const std::string& text, const std::string& what) {
  size_t count = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST_F(ViewTransfer, AddedLampsAreSaidToLightNothingOnce) {
  writeText(file("script.txt"),
            "frame\nlight add point 0,3,0 9,9,9 a\nframe\nlight add spot 0,3,0 9,9,9 b\nframe\n");
  const ProgramResult r = runProgram(command("--script " + file("script.txt"), "s%d.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  EXPECT_EQ(timesSaid(r.err, "lamps that were added light nothing"), 1) << r.err;
  const auto values = [&](const char* frame) {
    return io::readFilm(file(frame)).layers.at("").values;
  };
  EXPECT_EQ(values("s2.exr"), values("s0.exr"));
  writeText(file("script.txt"), "light add constant 0,1,0 1,1,1\nframe\n");
  expectFailure(command("--script " + file("script.txt"), "x.exr"), 3, "from all around already");
}

TEST_F(ViewTransfer, SaysWhichOptionsChangeNothing) {
  const ProgramResult r =
      runProgram(command("--light-cut 9 --plain-lobes --area-places 2 --component all", "x.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  for (const char* option : {"--light-cut", "--plain-lobes", "--area-places"})
    EXPECT_NE(r.err.find(std::string(option) + " has no effect: it is of frames by cuts"),
              std::string::npos)
        << r.err;
  EXPECT_EQ(timesSaid(r.err, "has no effect"), 3) << r.err;
  EXPECT_EQ(timesSaid(runProgram(command("", "x.exr")).err, "has no effect"), 0);
}

TEST_F(ViewTransfer, SaysThatDirectDataHaveNoIndirectLight) {
  const ProgramResult made =
      runProgram("precompute " + file("scene.xml") +
                 " --method vmf --directions 162 --rays 4 --subdivide 0 --bounces 0 --quiet -o " +
                 file("data"));
  ASSERT_EQ(made.exitCode, 0) << made.err;
  const ProgramResult r = runProgram(command("--component indirect", "x.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(r.err.find("frames by transfer are black"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace lobelia::test
