// `lobelia precompute` as a user types it.
#include <nlohmann/json.hpp>

#include "app/command_line.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::expectFailure;
using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

const std::string kCornell = "precompute cornell --detail 0.1 --method cuts --samples 512 ";

TEST(PrecomputeCommand, WritesDataAndStatistics) {
  const TemporaryFolder folder;
  for (const std::string light : {"environment", "surfaces"}) {
    const ProgramResult r =
        runProgram(kCornell + "--light " + light + " -o " + (folder / (light + ".cuts")) +
                   " --stats " + (folder / "stats.json"));
    ASSERT_EQ(r.exitCode, 0) << r.err;
    EXPECT_NE(r.err.find("vertices ("), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("RMS error"), std::string::npos) << r.err;
    const json stats = json::parse(test::readText(folder / "stats.json"));
    EXPECT_EQ(stats["precompute"]["method"], "cuts");
    EXPECT_EQ(stats["precompute"]["light"], light);
    EXPECT_EQ(stats["counts"]["samples"], 512);
    EXPECT_GT(stats["counts"]["vertices"], 10);
    EXPECT_GT(stats["counts"]["shadow_rays"], 1000);
    EXPECT_LE(stats["counts"]["rays_per_value"], 1.5);
    EXPECT_GE(stats["cuts"]["size"], 1);
    EXPECT_LT(stats["cuts"]["rms"], 0.5);
    EXPECT_EQ(stats["memory"]["file_bytes"],
              std::filesystem::file_size(folder / (light + ".cuts")));
    EXPECT_EQ(stats["seed"], 0);
    EXPECT_TRUE(stats["gather"]["threshold"].is_null());
    for (const char* key : {"version", "scene", "lights", "receivers", "memory"})
      EXPECT_TRUE(stats.contains(key)) << key;
    for (const char* key : {"rays_per_pixel", "node_pairs_visited", "nonfinite"})
      EXPECT_EQ(stats["counts"][key], 0) << key;
    EXPECT_EQ(stats["seconds"]["traverse"], 0);
    for (const char* stage : {"samples", "subdivision", "pilot", "trees", "visibility", "total"})
      EXPECT_GT(stats["seconds"][stage], 0) << stage;
  }
}

TEST(PrecomputeCommand, SameSeedSameFile) {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& options, const std::string& name) {
    const ProgramResult r = runProgram(kCornell + options + " --quiet -o " + (folder / name));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    EXPECT_EQ(r.err, "");
    return test::readText(folder / name);
  };
  const std::string one = file("--seed 3 --threads 1", "a");
  EXPECT_EQ(file("--seed 3 --threads 2", "b"), one);
  EXPECT_NE(file("--seed 4 --threads 2", "c"), one);
}

TEST(PrecomputeCommand, VerifiesAdaptiveTracing) {
  const TemporaryFolder folder;
  const ProgramResult r = runProgram(kCornell + "--adaptive verify --light surfaces -o " +
                                     (folder / "a") + " --stats " + (folder / "stats.json"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const json stats = json::parse(test::readText(folder / "stats.json"));
  EXPECT_LT(stats["counts"]["adaptive_rms"], 0.1);
}

TEST(PrecomputeCommand, WrongUsageIsTwo) {
  const TemporaryFolder folder;
  const std::string out = " -o " + (folder / "a.cuts");
  expectFailure("precompute cornell --method cuts", 2, "--output");
  expectFailure("precompute cornell" + out, 2, "--method");
  expectFailure("precompute cornell --method cutz" + out, 2, "did you mean 'cuts'");
  expectFailure(kCornell + "--samples 1000" + out, 2, "power of two");
  expectFailure(kCornell + "--samples 65536" + out, 2, "--samples");
  expectFailure(kCornell + "--samples 128" + out, 2, "from 256 to 32768");
  expectFailure(kCornell + "--clusters 3" + out, 2, "--clusters");
  expectFailure(kCornell + "--sigma -1" + out, 2, "--sigma");
  expectFailure(kCornell + "--sigma nan" + out, 2, "--sigma");
  expectFailure(kCornell + "--max-cut 0" + out, 2, "--max-cut");
  expectFailure(kCornell + "--beta 1.5" + out, 2, "--beta");
  expectFailure(kCornell + "--light sun" + out, 2, "--light");
  expectFailure(kCornell + "--adaptive maybe" + out, 2, "--adaptive");
  expectFailure(kCornell + "--subdivide 20" + out, 2, "--subdivide");
  expectFailure(kCornell + "-o " + (folder / "no/such.cuts"), 2, "no folder");
  expectFailure(kCornell + "-o " + folder.path(), 2, "is a folder");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.cuts"));
}

TEST(PrecomputeCommand, BadScenesAreThree) {
  const TemporaryFolder folder;
  const std::string out = " --method cuts -o " + (folder / "a.cuts");
  expectFailure("precompute cornel" + out, 3, "did you mean 'cornell'");
  expectFailure("precompute " + (folder / "none.xml") + out, 3, "none.xml");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.cuts"));
}

}  // namespace
}  // namespace lobelia
