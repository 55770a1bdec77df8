// --replay: the pixel's bits and what it says.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "app/moving_scene.h"
#include "lobelia/io/image_io.h"
#include "support/run_program.h"

namespace lobelia {
namespace {

using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

using Pixel = std::pair<int, int>;
const std::vector<Pixel> kPixels{{2, 1}, {10, 12}, {16, 8}};

void expectSameValue(const std::string& options,
                     const std::string& program = "cornell --detail 0.1",
                     const std::vector<Pixel>& pixels = kPixels) {
  const TemporaryFolder folder;
  const std::string command =
      "render " + program + " --size 20x15 --crop 2,1,18,15 --quiet " + options;
  ASSERT_EQ(runProgram(command + " -o " + (folder / "a%d.exr")).exitCode, 0);
  const bool frame = options.find("--frame 2") != std::string::npos;
  const Film film = io::readFilm(folder / (frame ? "a2.exr" : "a%d.exr"));
  for (const auto& [x, y] : pixels) {
    const std::string at = std::to_string(x) + "," + std::to_string(y);
    const ProgramResult r = runProgram(command + " --replay " + at);
    ASSERT_EQ(r.exitCode, 0) << r.err;
    const std::string last = "pixel " + at + ": (";
    const size_t found = r.out.find(last);
    ASSERT_NE(found, std::string::npos) << r.out;
    Rgb value;
    ASSERT_EQ(
        std::sscanf(r.out.c_str() + found + last.size(), "%f %f %f", &value.x, &value.y, &value.z),
        3);
    const Rgb expected =
        film.rgb(static_cast<size_t>(y - film.y0) * static_cast<size_t>(film.width) +
                 static_cast<size_t>(x - film.x0));
    EXPECT_TRUE(value == expected) << options << " at " << at << "\n" << r.out;
  }
}

TEST(Replay, PathsGiveThePicturesBits) {
  expectSameValue("--lights path --spp 20 --seed 5");
  expectSameValue("--lights path --spp 3 --component indirect");
}

// All pixels of one method, and one of every other: they take turns. Most of a run is its start.
TEST(Replay, VirtualLightsGiveThePicturesBits) {
  expectSameValue("--spp 4 --num-lights 200");
  size_t turn = 0;
  for (const char* method :
       {"--lights vpl --spp 3 --passes 1 --num-lights 150 --direct lights",
        "--gather mrcs --spp 4 --passes 2 --num-lights 700 --columns 60 --rows 90",
        "--gather sglc --spp 3 --passes 2 --num-lights 700 --cut-size 40",
        "--gather lightslice --spp 4 --passes 2 --num-lights 700 --columns 60",
        "--gather lightcuts --spp 3 --passes 2 --num-lights 700 --cut-size 40",
        "--gather stochastic --spp 3 --passes 2 --num-lights 700 --cut-size 40",
        "--gather mdlc --spp 6 --passes 2 --num-lights 700 --cut-size 60",
        "--gather illumcut --spp 2 --passes 2 --num-lights 700",
        "--lights richvpl --spp 3 --passes 2 --num-lights 700 --richvpl-lights 60",
        "--gather sglc --sglc-mode paper --spp 2 --passes 2 --num-lights 700",
        "--lights vpl --compensate --spp 3 --passes 1 --num-lights 150",
        "--lights vsl --gather sglc --near-lights 40 --spp 3 --passes 2 --num-lights 700",
        "--lights photon --spp 3 --passes 2 --num-lights 3000"})
    expectSameValue(method, "study-phong --detail 0.1", {kPixels[turn++ % kPixels.size()]});
}

TEST(Replay, OfOneFrameGivesItsBits) {
  const TemporaryFolder folder;
  const std::string scene = test::writeMovingScene(folder);
  for (const char* motion :
       {"--frames 4 --frame 2 ", "--frames 4 --frame 2 --turntable --camera a "})
    expectSameValue(std::string(motion) + "--lights path --spp 3", scene);
  const ProgramResult r = runProgram("render " + scene + " --frames 4 --replay 3,3");
  EXPECT_EQ(r.exitCode, 2) << r.err;
  EXPECT_NE(r.err.find("--frame K"), std::string::npos) << r.err;
}

TEST(Replay, TellsWhatHappened) {
  const ProgramResult path =
      runProgram("render cornell --size 32x32 --lights path --spp 24 --quiet --replay 16,20");
  ASSERT_EQ(path.exitCode, 0) << path.err;
  for (const char* part :
       {"sample 15", "depth 1", "material '", "emitter sample", "8 samples more"})
    EXPECT_NE(path.out.find(part), std::string::npos) << part << "\n" << path.out;
  EXPECT_EQ(path.out.find("sample 16\n"), std::string::npos);
  const ProgramResult lights =
      runProgram("render cornell --size 32x32 --spp 2 --num-lights 100 --quiet --replay 16,20");
  ASSERT_EQ(lights.exitCode, 0) << lights.err;
  for (const char* part : {"sample 1", "receiver at", "gathered:", "lights contribute"})
    EXPECT_NE(lights.out.find(part), std::string::npos) << part << "\n" << lights.out;
}

TEST(Replay, WrongUseIsRefused) {
  const auto expectRefused = [](const std::string& options, const char* mentions) {
    const ProgramResult r = runProgram("render cornell --size 32x32 --quiet " + options);
    EXPECT_EQ(r.exitCode, 2) << options << "\n" << r.err;
    EXPECT_NE(r.err.find(mentions), std::string::npos) << options << "\nsaid: " << r.err;
  };
  expectRefused("--replay 3", "X,Y");
  expectRefused("--replay 3,4x", "X,Y");
  expectRefused("--replay 32,0", "from 0 to 31");
  expectRefused("--replay 3,4 --lights light", "belong to no pixel");
}

}  // namespace
}  // namespace lobelia
