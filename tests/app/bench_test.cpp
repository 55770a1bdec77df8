// `lobelia bench` at tiny sizes: every study runs, and its JSON holds what docs/performance.md is
// made from.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_program.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

json runBench(const std::string& arguments, std::string* markdown = nullptr) {
  const TemporaryFolder folder;
  const ProgramResult r =
      runProgram("bench " + arguments + " --quiet --json " + (folder / "bench.json"));
  EXPECT_EQ(r.exitCode, 0) << arguments << "\n" << r.err;
  if (markdown) *markdown = r.out;
  const json result = json::parse(test::readText(folder / "bench.json"), nullptr, false);
  EXPECT_FALSE(result.is_discarded()) << "not JSON: " << arguments;
  for (const char* key : {"bench", "version", "command", "seed", "processor", "threads"})
    EXPECT_TRUE(result.contains(key)) << key;
  return result;
}

void expectNumbers(const json& rows, size_t count, const std::vector<std::string>& keys) {
  ASSERT_EQ(rows.size(), count) << rows;
  for (const json& row : rows) {
    for (const std::string& key : keys) {
      ASSERT_TRUE(row.contains(key)) << key << " in " << row;
      ASSERT_TRUE(row[key].is_number()) << key << " in " << row;
    }
  }
}

TEST(Bench, UnknownNamesAreToldTheNearest) {
  const ProgramResult r = runProgram("bench rate");
  EXPECT_EQ(r.exitCode, 2);
  EXPECT_NE(r.err.find("did you mean 'rates'"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("convergence"), std::string::npos) << r.err;
  EXPECT_EQ(runProgram("bench").exitCode, 2);
  EXPECT_EQ(runProgram("bench clamp --json /no/such/folder/a.json").exitCode, 2);
  EXPECT_EQ(runProgram("bench clamp --scene missing.xml").exitCode, 3);
}

TEST(Bench, Rates) {
  std::string text;
  const json result =
      runBench("rates --detail 0.1 --size 64x48 --num-lights 40 --spp 1 --sets 2", &text);
  expectNumbers(result["bare"], 3, {"mrays_per_second", "visible"});
  expectNumbers(result["gather"], 6,
                {"gather_mrays_per_second", "bare_mrays_per_second_processor", "ratio",
                 "ratio_processor", "ratio_one_light"});
  expectNumbers(result["path"], 3, {"path_mrays_per_second", "ratio", "ratio_processor"});
  for (const json& row : result["gather"]) EXPECT_GT(row["gather_mrays_per_second"], 0) << row;
  for (const json& row : result["bare"]) {
    EXPECT_GT(row["visible"], 0) << row;
    EXPECT_LE(row["visible"], 1) << row;
  }
  EXPECT_NE(text.find("| pixels in tile order to one light |"), std::string::npos) << text;
}

TEST(Bench, RatesOfOnesOwnScene) {
  const json result =
      runBench("rates --scene cornell --detail 0.1 --size 32x32 --num-lights 40 --spp 1 --sets 2");
  expectNumbers(result["gather"], 2, {"ratio"});
  expectNumbers(result["path"], 1, {"ratio"});
  EXPECT_EQ(result["path"][0]["scene"], "cornell");
}

TEST(Bench, Picture) {
  const json result = runBench("picture --detail 0.1 --size 16x16 --num-lights 64 --spp 64");
  expectNumbers(result["picture"], 5, {"seconds", "mrays", "l2", "mean_ratio"});
  EXPECT_EQ(result["picture"][0]["method"], "glossy");
  EXPECT_EQ(result["picture"][4]["method"], "path");
  EXPECT_TRUE(result["picture"][4]["lights"].is_null());
  EXPECT_NEAR(result["picture"][4]["mean_ratio"].get<double>(), 1, 0.25);
}

// Tighter clamps lose more; on a diffuse scene little is lost without one.
TEST(Bench, Clamp) {
  const json result = runBench(
      "clamp --scene study-diffuse --detail 0.5 --pixels 64 --num-lights 256 --spp 256 --sets 4");
  const json& rows = result["clamp"];
  expectNumbers(rows, 10, {"vpl_ratio", "vpl_error", "vpl_l2", "glossy_ratio", "glossy_l2"});
  EXPECT_EQ(rows.back()["clamp"], "off");
  for (size_t i = 1; i < rows.size(); ++i) {
    EXPECT_GE(rows[i]["vpl_ratio"].get<double>(), rows[i - 1]["vpl_ratio"].get<double>() - 1e-6);
  }
  EXPECT_LT(rows[0]["vpl_ratio"], 0.5);
  EXPECT_NEAR(rows.back()["vpl_ratio"].get<double>(), 1, 0.1);
}

TEST(Bench, Convergence) {
  const std::string arguments =
      "convergence --detail 0.5 --pixels 64 --num-lights 512 --spp 256 --sets 12";
  const json result = runBench(arguments);
  const json& rows = result["convergence"];
  expectNumbers(rows, 15, {"lights", "sets", "mean_ratio", "error", "l2", "target"});
  for (const json& row : rows) {
    const double deviation = std::abs(row["mean_ratio"].get<double>() - 1);
    EXPECT_LT(deviation, 0.05 + 5 * row["error"].get<double>()) << row;
  }
  EXPECT_EQ(runBench(arguments + " --threads 1")["convergence"], rows) << "depends on threads";
}

}  // namespace
}  // namespace lobelia
