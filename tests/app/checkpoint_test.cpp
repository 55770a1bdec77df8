// Renders that are killed and go on: same pixels; checkpoints that do not fit are refused.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "lobelia/io/image_io.h"
#include "support/run_program.h"

namespace lobelia {
namespace {

using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

struct Method {
  const char* name;
  const char* options;
};
void PrintTo(const Method& method, std::ostream* out) { *out << method.name; }

constexpr const char* kScene = "render cornell --detail 0.05 --checkpoint-interval 0.005 ";

void expectSamePicture(const std::string& a, const std::string& b) {
  const Film first = io::readFilm(a), second = io::readFilm(b);
  ASSERT_EQ(first.layers.size(), second.layers.size());
  for (const auto& [name, layer] : first.layers) {
    ASSERT_TRUE(second.layers.contains(name)) << name;
    const std::vector<float>& other = second.layers.at(name).values;
    ASSERT_EQ(layer.values.size(), other.size()) << name;
    EXPECT_EQ(std::memcmp(layer.values.data(), other.data(), other.size() * sizeof(float)), 0)
        << "layer '" << name << "' differs";
  }
  EXPECT_EQ(first.alpha, second.alpha);
}

// Changes whenever the file is written anew.
std::pair<ino_t, int64_t> versionOf(const std::string& file) {
  struct stat s {};
  if (stat(file.c_str(), &s) != 0) return {0, 0};
  return {s.st_ino, static_cast<int64_t>(s.st_mtim.tv_sec) * 1'000'000'000 + s.st_mtim.tv_nsec};
}

// Starts the program and sends the signal as soon as it has written the checkpoint; false when it
// had ended by itself.
bool interrupted(const std::string& arguments, int signal, const std::string& checkpoint) {
  const std::string command =
      "exec " + std::string(LOBELIA_PROGRAM) + " " + arguments + " --quiet >/dev/null 2>&1";
  const auto before = versionOf(checkpoint);
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  while (versionOf(checkpoint) == before) {
    if (waitpid(child, &status, WNOHANG) == child) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, signal);
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) || WEXITSTATUS(status) >= 128;
}

class Checkpoint : public testing::TestWithParam<Method> {};

// Stopped by its time limit, killed, interrupted, and gone on with each time.
TEST_P(Checkpoint, StoppedRendersEndAsIfNothingHadHappened) {
  const TemporaryFolder folder;
  const std::string options = std::string(kScene) + GetParam().options;
  ASSERT_EQ(
      runProgram(options + " -o " + (folder / "whole.exr") + " --stats " + (folder / "whole.json"))
          .exitCode,
      0);
  const std::string checkpoint = folder / "checkpoint";
  const std::string resumed = options + " --resume " + checkpoint + " -o " + (folder / "cut.exr") +
                              " --stats " + (folder / "cut.json");
  ASSERT_EQ(runProgram(resumed + " --time-limit 0.001").exitCode, 0);
  ASSERT_TRUE(std::filesystem::exists(checkpoint));
  // The first must come before the end of the picture; a busy machine may need several tries.
  bool killed = false;
  for (int i = 0; i < 20 && !killed; ++i) {
    if (i > 0) std::filesystem::remove(checkpoint);
    std::filesystem::remove(folder / "cut.exr");
    killed =
        interrupted(resumed, SIGKILL, checkpoint) && !std::filesystem::exists(folder / "cut.exr");
  }
  ASSERT_TRUE(killed);
  interrupted(resumed, SIGINT, checkpoint);
  const ProgramResult last = runProgram(resumed + " --threads 1");
  ASSERT_EQ(last.exitCode, 0) << last.err;
  EXPECT_NE(last.err.find("going on from " + checkpoint), std::string::npos) << last.err;
  expectSamePicture(folder / "cut.exr", folder / "whole.exr");
  for (const char* part : {"counts", "gather"}) {
    const auto statistics = [&](const char* file) {
      return nlohmann::json::parse(test::readText(folder / file))[part];
    };
    EXPECT_EQ(statistics("cut.json"), statistics("whole.json")) << part;
  }
  // What is finished is written again, without rendering.
  std::filesystem::remove(folder / "cut.exr");
  ASSERT_EQ(runProgram(resumed).exitCode, 0);
  expectSamePicture(folder / "cut.exr", folder / "whole.exr");
}

INSTANTIATE_TEST_SUITE_P(
    Methods, Checkpoint,
    testing::Values(Method{"path",
                           "--lights path --size 48x40 --spp 32 --seed 3 "
                           "--aov albedo,normal,depth,direct,indirect,variance,groups,cost"},
                    Method{"light",
                           "--lights light --size 48x40 --spp 150 "
                           "--aov direct,indirect,variance,groups"},
                    Method{"glossy",
                           "--size 48x40 --spp 8 --num-lights 600 "
                           "--aov direct,indirect,specular,variance,groups,types,cost"},
                    Method{"mrcs",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --gather mrcs "
                           "--columns 120 --rows 100 --aov direct,indirect,variance,cost"},
                    Method{"sglc",
                           "--lights vsl --size 48x40 --spp 6 --passes 3 --num-lights 2000 "
                           "--gather sglc --cut-size 50 --aov direct,indirect,variance,cost,types"},
                    Method{"lightslice",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --gather lightslice "
                           "--columns 60 --slices 20 --aov direct,indirect,variance,cost"},
                    Method{"lightcuts",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --gather lightcuts "
                           "--cut-size 60 --aov direct,indirect,variance,cost,types"},
                    Method{"stochastic",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --gather stochastic "
                           "--cut-size 30 --aov direct,indirect,variance,cost"},
                    Method{"mdlc",
                           "--size 48x40 --spp 12 --passes 3 --num-lights 900 --gather mdlc "
                           "--cut-size 60 --aov direct,indirect,variance,cost,types"},
                    Method{"illumcut",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --gather illumcut "
                           "--aov direct,indirect,variance,cost,types"},
                    Method{"richvpl",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --lights richvpl "
                           "--richvpl-lights 60 --aov direct,indirect,variance,cost,types"},
                    Method{"richvpl_cube",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --lights richvpl "
                           "--richvpl-lights 60 --richvpl-radiance cube --richvpl-texels 8 "
                           "--aov direct,indirect,variance,cost"},
                    Method{"pairs",
                           "--size 48x40 --spp 6 --passes 3 --num-lights 900 --gather sglc "
                           "--sglc-mode paper --aov direct,indirect,variance,cost,types"},
                    Method{"pixels",
                           "--lights vpl --size 64x64 --pixels 500 --spp 8 "
                           "--num-lights 500 --passes 2 --direct lights"},
                    Method{"compensate",
                           "--lights vpl --compensate --size 48x40 --spp 8 --num-lights 300 "
                           "--aov direct,indirect,variance,groups,cost"},
                    Method{"near_lights",
                           "--near-lights 30 --gather sglc --size 48x40 --spp 8 --num-lights 900 "
                           "--aov direct,indirect,variance,groups,cost"},
                    Method{"photon",
                           "--lights photon --size 48x40 --spp 16 --num-lights 2000 "
                           "--aov direct,indirect,variance,groups,cost"}),
    [](const auto& param) { return std::string(param.param.name); });

TEST(CheckpointFile, AnotherFileIsNotReplaced) {
  const TemporaryFolder folder;
  const std::string file = folder / "notes.txt", text = "what this is about, in many words";
  const std::string made = std::string(kScene) + "--size 8x8 --spp 1 --num-lights 50 -o " +
                           (folder / "a.exr") + " --checkpoint ";
  test::writeText(file, text);
  const ProgramResult r = runProgram(made + file);
  EXPECT_EQ(r.exitCode, 3) << r.err;
  EXPECT_NE(r.err.find("no checkpoint"), std::string::npos) << r.err;
  EXPECT_EQ(test::readText(file), text);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
  // Of a checkpoint it makes a new one, of an empty file one.
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(runProgram(made + (folder / "checkpoint")).exitCode, 0);
    test::writeText(folder / "checkpoint2", "");
    EXPECT_EQ(runProgram(made + (folder / "checkpoint2")).exitCode, 0);
  }
}

TEST(CheckpointFile, OfOtherSphericalLightsIsRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "checkpoint", out = " -o " + (folder / "a.exr");
  const std::string made = std::string(kScene) +
                           "--lights vsl --size 16x16 --spp 2 --num-lights 50 --seed 1 --radius 3 ";
  ASSERT_EQ(runProgram(made + "--checkpoint " + file + out).exitCode, 0);
  EXPECT_EQ(runProgram(made + "--resume " + file + out).exitCode, 0);
  const std::string other =
      std::string(kScene) + "--lights vsl --size 16x16 --spp 2 --num-lights 50 --seed 1 ";
  for (const std::string& change : {other + "--radius 4", made + "--vsl-indicator cosine",
                                    made + "--vsl-sampling cone", made + "--vsl-samples 4"}) {
    const ProgramResult r = runProgram(change + " --resume " + file + out);
    EXPECT_EQ(r.exitCode, 3) << change << "\n" << r.err;
    EXPECT_NE(r.err.find("(now "), std::string::npos) << r.err;
  }
}

// What is not asked for any more, or means something else now, is no reason.
TEST(CheckpointFile, SettingsOfAnotherChoiceAreNotNamed) {
  const TemporaryFolder folder;
  const std::string file = folder / "checkpoint", out = " -o " + (folder / "a.exr ");
  const std::string made = kScene + ("--size 8x8 --spp 2 --num-lights 50" + out);
  const auto reasons = [&](const std::string& before, const std::string& now) {
    EXPECT_EQ(runProgram(made + before + " --checkpoint " + file).exitCode, 0) << before;
    const ProgramResult r = runProgram(made + now + " --resume " + file);
    EXPECT_EQ(r.exitCode, 3) << r.err;
    const size_t begin = r.err.find("made with ") + 10;
    return r.err.substr(begin, r.err.find(';') - begin);
  };
  EXPECT_EQ(reasons("--gather mrcs --columns 20 --rows 30", "--gather lightslice"),
            "--gather mrcs (now lightslice)");
  EXPECT_EQ(reasons("--gather sglc --cut-size 9", "--gather sglc --sglc-mode paper"),
            "--sglc-mode shared (now paper)");
  EXPECT_EQ(reasons("--lights richvpl --richvpl-lobes 4", "--lights richvpl --richvpl-lights 9"),
            "--richvpl-lights 1000 (now 9), --richvpl-lobes 4 (now 8)");
  EXPECT_EQ(reasons("--gather stochastic", "--lights path"), "--lights glossy (now path)");
  EXPECT_EQ(reasons("--gather lightcuts", "--gather lightcuts --threshold 0.1 --seed 2"),
            "--seed 0 (now 2), --threshold 0.02 (now 0.1)");
  EXPECT_EQ(runProgram(made + "--gather lightcuts --gather-rays 9 --env-lights 7 --resume " + file)
                .exitCode,
            0);
}

TEST(CheckpointFile, OfAnotherRenderIsRefusedAndSaysWhy) {
  const TemporaryFolder folder;
  const std::string file = folder / "checkpoint", out = " -o " + (folder / "a.exr");
  const std::string made = std::string(kScene) + "--lights path --size 16x16 --spp 4 --seed 1";
  ASSERT_EQ(runProgram(made + " --checkpoint " + file + out).exitCode, 0);
  const auto expectRefused = [&](const std::string& arguments, const char* mentions) {
    const ProgramResult r = runProgram(arguments + " --resume " + file + out);
    EXPECT_EQ(r.exitCode, 3) << arguments << "\n" << r.err;
    EXPECT_NE(r.err.find(mentions), std::string::npos) << arguments << "\nsaid: " << r.err;
  };
  const std::string base = std::string(kScene) + "--lights path ";
  expectRefused(base + "--size 16x16 --spp 4 --seed 2", "--seed 1 (now 2)");
  expectRefused(base + "--size 16x16 --spp 8 --seed 1", "--spp 4 (now 8)");
  expectRefused(base + "--size 17x16 --spp 4 --seed 1", "--size 16x16 (now 17x16)");
  expectRefused(made + " --component direct", "--component all (now direct)");
  expectRefused(std::string(kScene) + "--size 16x16 --spp 4 --seed 1", "--lights path");
  expectRefused("render cornell --detail 0.2 --quiet --lights path --size 16x16 --spp 4 --seed 1",
                "another scene");
  EXPECT_EQ(runProgram(made + " --threads 2 --resume " + file + out).exitCode, 0);

  const std::string bytes = test::readText(file);
  std::string damaged = bytes;
  damaged[damaged.size() / 2] ^= 0x10;
  test::writeText(file, damaged);
  expectRefused(made, "checksum");
  test::writeText(file, bytes.substr(0, bytes.size() / 2));
  expectRefused(made, "truncated");
  std::string newer = bytes;
  newer[28] = 99;  // the version of the kind: after magic, layout version and kind
  test::writeText(file, newer);
  expectRefused(made, "version 99");
  test::writeText(file, "not a checkpoint");
  expectRefused(made, "not a Lobelia data file");
  std::filesystem::remove(file);
  EXPECT_EQ(runProgram(made + " --checkpoint " + file + out).exitCode, 0);
  EXPECT_EQ(runProgram(made + " --resume " + file + " --checkpoint " + file + out).exitCode, 2);
}

}  // namespace
}  // namespace lobelia
