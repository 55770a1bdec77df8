// `lobelia precompute --method vmf` as a user types it.
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/block_scene.h"
#include "app/command_line.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::expectFailure;
using test::ProgramResult;
using test::runProgram;

class PrecomputeVmf : public testing::Test {
 protected:
  PrecomputeVmf() { test::writeText(scene_, test::kBlockScene); }

  const test::TemporaryFolder folder_;
  const std::string scene_ = folder_ / "scene.xml";
  const std::string base_ = "precompute " + scene_ + " --method vmf ";
  const std::string quick_ = base_ + "--directions 162 --rays 4 ";
};

TEST_F(PrecomputeVmf, WritesDataAndStatistics) {
  const ProgramResult r =
      runProgram(quick_ + "--bounces 1 --mask-level 4 --mask-tolerance 0.1 --subdivide 1 -o " +
                 (folder_ / "a.vmf") + " --stats " + (folder_ / "stats.json"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(r.err.find("2 passes"), std::string::npos) << r.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.vmf.work"));
  const json stats = json::parse(test::readText(folder_ / "stats.json"));
  EXPECT_EQ(stats["precompute"]["method"], "vmf");
  EXPECT_EQ(stats["precompute"]["mask_tolerance"], 0.1);
  const json& transfer = stats["transfer"];
  EXPECT_EQ(transfer["directions"], 162);
  EXPECT_EQ(transfer["passes"], 2);
  EXPECT_EQ(transfer["classes"], 1);
  EXPECT_EQ(transfer["lobes"], 3) << "one of direct light; glossy and diffuse paths of a bounce";
  EXPECT_EQ(transfer["vertices"], stats["counts"]["vertices"]);
  EXPECT_GT(stats["counts"]["vertices_added"], 0);
  EXPECT_EQ(transfer["records"], stats["counts"]["records"]);
  EXPECT_DOUBLE_EQ(
      transfer["density"].get<double>(),
      transfer["records"].get<double>() / (transfer["vertices"].get<double>() * 162 * 3));
  ASSERT_EQ(transfer["density_by_pass"].size(), 2);
  EXPECT_NEAR(3 * transfer["density"].get<double>(),
              transfer["density_by_pass"][0].get<double>() +
                  2 * transfer["density_by_pass"][1].get<double>(),
              1e-9);
  EXPECT_EQ(stats["counts"]["shadow_rays"].get<uint64_t>(),
            stats["counts"]["mask_rays"].get<uint64_t>() +
                stats["counts"]["transfer_rays"].get<uint64_t>());
  EXPECT_EQ(stats["memory"]["data_bytes"], transfer["bytes"]);
  EXPECT_GT(stats["memory"]["peak_bytes"], stats["memory"]["data_bytes"]);
  EXPECT_GT(stats["precompute"]["memory"], 0) << "the machine's, where none is given";
  EXPECT_EQ(stats["counts"]["blocks_resumed"], 0);
  EXPECT_EQ(r.err.find("resumed"), std::string::npos) << r.err;
  EXPECT_EQ(stats["memory"]["file_bytes"], std::filesystem::file_size(folder_ / "a.vmf"));
  for (const char* stage : {"load", "masks", "trace", "direct", "bounce", "save", "total"})
    EXPECT_GT(stats["seconds"][stage], 0) << stage;
  for (const char* stage : {"receivers", "lights", "trees", "traverse", "visibility", "shade"})
    EXPECT_EQ(stats["seconds"][stage], 0) << stage;
  for (const char* key : {"rays_per_pixel", "node_pairs_visited", "nonfinite"})
    EXPECT_EQ(stats["counts"][key], 0) << key;
  EXPECT_EQ(stats["lights"]["model"], "environment");
}

TEST_F(PrecomputeVmf, TheSameFileForAnyNumberOfThreadsAndWithoutAFolder) {
  const auto dataOf = [&](const std::string& options, const std::string& name) {
    const ProgramResult r = runProgram(quick_ + options + " --quiet -o " + (folder_ / name));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_EQ(r.err, "");
    return test::readText(folder_ / name);
  };
  const std::string one = dataOf("--subdivide 0 --threads 1", "a");
  EXPECT_EQ(dataOf("--subdivide 0 --threads 2", "b"), one);
  EXPECT_EQ(dataOf("--subdivide 0 --work none", "c"), one);
  EXPECT_NE(dataOf("--subdivide 0 --lobes materials", "d"), one);
}

// Starts the program, and interrupts it as soon as the folder has so many files; false when it had
// ended by itself.
bool interrupted(const std::string& arguments, const std::string& folder, int files,
                 const std::string& said) {
  const std::string command =
      "exec " + std::string(LOBELIA_PROGRAM) + " " + arguments + " >/dev/null 2>" + said;
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  const auto count = [&] {
    std::error_code error;
    return std::distance(std::filesystem::directory_iterator(folder, error), {});
  };
  int status = 0;
  while (count() < files) {
    if (waitpid(child, &status, WNOHANG) == child) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGINT);
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 130;
}

TEST_F(PrecomputeVmf, AFullDiskLeavesWhatIsDone) {
  const std::string work = folder_ / "a/b/work";
  const std::string run = quick_ + "--subdivide 0 --bounces 1 --work " + work + " -o ";
  expectFailure(run + "/dev/full", 1, "cannot write /dev/full");
  EXPECT_FALSE(std::filesystem::is_empty(work));
  const ProgramResult r = runProgram(run + (folder_ / "a.vmf"));
  EXPECT_EQ(r.exitCode, 0) << r.err;
  EXPECT_NE(r.err.find("going on from"), std::string::npos) << r.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
}

TEST_F(PrecomputeVmf, GoesOnWhereItWasStopped) {
  const std::string work = folder_ / "work", said = folder_ / "said";
  const std::string run =
      quick_ + "--subdivide 3 --mask-level 4 --mask-tolerance 0.05 --bounces 2 --work " + work;
  ASSERT_EQ(runProgram(run + " --quiet -o " + (folder_ / "whole")).exitCode, 0);
  bool stopped = false;
  for (int i = 0; i < 20 && !stopped; ++i) {  // a busy machine may need several tries
    std::filesystem::remove(folder_ / "cut");
    stopped = interrupted(run + " -o " + (folder_ / "cut"), work, 4, said) &&
              !std::filesystem::exists(folder_ / "cut");
  }
  ASSERT_TRUE(stopped);
  const std::string text = test::readText(said);
  EXPECT_NE(text.find("goes on from what is done, in " + work), std::string::npos) << text;

  expectFailure(run + " --lobes materials -o " + (folder_ / "cut"), 3, "of other settings");
  const ProgramResult last =
      runProgram(run + " -o " + (folder_ / "cut") + " --stats " + (folder_ / "stats.json"));
  ASSERT_EQ(last.exitCode, 0) << last.err;
  EXPECT_NE(last.err.find("going on from " + work), std::string::npos) << last.err;
  EXPECT_EQ(test::readText(folder_ / "cut"), test::readText(folder_ / "whole"));
  const json counts = json::parse(test::readText(folder_ / "stats.json"))["counts"];
  EXPECT_GT(counts["blocks_resumed"], 0);
  EXPECT_GT(counts["blocks"], counts["blocks_resumed"]);
  EXPECT_GT(counts["vertices_added"], 0) << "by the run before";
  const std::string resumed = "rays of this run, which resumed " +
                              std::to_string(counts["blocks_resumed"].get<int>()) + " of " +
                              std::to_string(counts["blocks"].get<int>()) + " blocks";
  EXPECT_NE(last.err.find(resumed), std::string::npos) << last.err;
  EXPECT_FALSE(std::filesystem::exists(work));
}

TEST_F(PrecomputeVmf, WrongUsageIsTwo) {
  const std::string out = " -o " + (folder_ / "a.vmf");
  expectFailure(base_ + "--directions 640" + out, 2, "--directions");
  expectFailure(base_ + "--bounces 65" + out, 2, "--bounces");
  expectFailure(base_ + "--lobes two" + out, 2, "--lobes");
  expectFailure(base_ + "--rays 8" + out, 2, "--rays");
  expectFailure(base_ + "--mask-level 8" + out, 2, "--mask-level");
  expectFailure(base_ + "--mask-tolerance 2" + out, 2, "--mask-tolerance");
  expectFailure(base_ + "--memory much" + out, 2, "--memory");
  const std::string cuts = "precompute " + scene_ + " --method cuts ";
  for (const char* option : {"--directions 642", "--bounces 2", "--lobes one", "--rays auto",
                             "--mask-level 6", "--mask-tolerance 0.1", "--memory 1G", "--work w"})
    expectFailure(cuts + option + out, 2, "--method cuts has no such option");
  for (const char* option : {"--light surfaces", "--samples 512", "--sigma 1", "--max-cut 9",
                             "--beta 1", "--clusters 4", "--adaptive on", "--horizon keep"})
    expectFailure(base_ + option + out, 2, "--method vmf has no such option");
  for (const char* option : {"--seed 1", "--slice-rays 9"})
    expectFailure(base_ + option + out, 2, "--solver gather has no such option");
  for (const char* option : {"--rays 5", "--memory 1G", "--work w"})
    expectFailure(base_ + "--solver scatter " + option + out, 2,
                  "--solver scatter has no such option");
  expectFailure(base_ + "--directions 10242 --rays 4" + out, 2, "finer than the grid of --rays 4");
  // Before the scene is read, of which nothing is said.
  const std::string none = "precompute none.xml --method vmf";
  test::writeText(folder_ / "file", "mine");
  for (const char* work : {"file", "file/x", "file/x/y"})
    expectFailure(none + " --work " + (folder_ / work) + out, 2, "is not a folder");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.vmf"));
}

TEST_F(PrecomputeVmf, ScattersForComparison) {
  const std::string mesh =
      base_ + "--directions 162 --subdivide 1 --mask-level 4 --mask-tolerance 0.2 --bounces 1 ";
  const std::string stats = folder_ / "stats.json";
  const auto scattered = [&](const std::string& options, const std::string& name) {
    const ProgramResult r = runProgram(mesh + "--solver scatter --slice-rays 4 --quiet " + options +
                                       " -o " + (folder_ / name) + " --stats " + stats);
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / (name + ".work")));
    return test::readText(folder_ / name);
  };
  const std::string one = scattered("--seed 3", "a");
  EXPECT_EQ(scattered("--seed 3 --threads 1", "b"), one);
  EXPECT_NE(scattered("--seed 4", "c"), one);
  const json made = json::parse(test::readText(stats));
  EXPECT_EQ(made["precompute"]["solver"], "scatter");
  EXPECT_EQ(made["precompute"]["slice_rays"], 4);
  EXPECT_GT(made["seconds"]["scatter"], 0);
  EXPECT_GT(made["rays_per_second"], 0);
  EXPECT_GT(made["counts"]["slices"], 0);
  EXPECT_EQ(made["counts"]["vertices"], made["transfer"]["vertices"]);
  EXPECT_EQ(made["seed"], 4);
  const ProgramResult gathered =
      runProgram(mesh + "--rays 4 --quiet -o " + (folder_ / "d") + " --stats " + stats);
  ASSERT_EQ(gathered.exitCode, 0) << gathered.err;
  EXPECT_EQ(made["transfer"]["vertices"],
            json::parse(test::readText(stats))["transfer"]["vertices"])
      << "the same mesh";
  const ProgramResult shown = runProgram("view " + scene_ + " --headless --quiet --data " +
                                         (folder_ / "a") + " -o " + (folder_ / "a.exr"));
  EXPECT_EQ(shown.exitCode, 0) << shown.err;
}

TEST_F(PrecomputeVmf, WarnsOfWhatTheDataWillNotShow) {
  std::string scene = test::kBlockScene;
  const size_t from = scene.find("<emitter"), to = scene.find("</emitter>");
  scene.replace(from, to - from, R"(<emitter type="point"><point name="position" value="0, 3, 0"/>
    <rgb name="intensity" value="9"/>)");
  const size_t at = scene.find("<bsdf type=\"diffuse\"");
  scene.replace(at, scene.find("</bsdf>") - at, R"(<bsdf type="roughdielectric">)");
  test::writeText(scene_, scene);
  const ProgramResult r =
      runProgram(quick_ + "--max-vertices 5 --mask-level 4 --bounces 0 -o " + (folder_ / "a.vmf"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  for (const char* said :
       {"no light from infinity", "1 of 1 emitters are not at infinity",
        "1 surfaces transmit light", "--max-vertices 5: the scene itself has 28"})
    EXPECT_NE(r.err.find(said), std::string::npos) << said << "\n" << r.err;
}

TEST_F(PrecomputeVmf, TooLittleMemoryIsSaid) {
  expectFailure(quick_ + "--subdivide 0 --memory 2K --work none -o " + (folder_ / "a.vmf"), 1,
                "--memory");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.vmf"));
}

}  // namespace
}  // namespace lobelia
