// `lobelia bench` at tiny sizes: every study runs, and its JSON holds what docs/performance.md is
// made from.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
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
  EXPECT_EQ(runProgram("bench clamp --scene study-ggx --scene study-phong").exitCode, 2);
  EXPECT_EQ(runProgram("bench clamp --columns 10").exitCode, 2);
  EXPECT_EQ(runProgram("bench vsl --figures 1,3").exitCode, 2);
  EXPECT_EQ(runProgram("bench vsl --figures 1,").exitCode, 2);
  EXPECT_EQ(runProgram("bench sglc --figures 1").exitCode, 2);
  EXPECT_EQ(runProgram("bench sglc --columns 10").exitCode, 2);
  EXPECT_EQ(runProgram("bench clamp --figures 4").exitCode, 2);
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

std::string tinyVsl(const std::string& size, int lights, int columns) {
  return fmt::format(
      " --detail 0.2 --size {} --pixels 160 --num-lights {} --columns {} --rows 48 --spp 128 ",
      size, lights, columns);
}

void expectPictures(const TemporaryFolder& folder, const std::string& study,
                    const std::vector<std::string>& names) {
  const std::string page = test::readText(folder / (study + ".md"));
  for (const std::string& name : names) {
    EXPECT_TRUE(std::filesystem::exists(folder / (name + ".png"))) << name;
    EXPECT_NE(page.find("(" + name + ".png)"), std::string::npos) << name << " in\n" << page;
  }
}

double l2Of(const json& rows, const std::string& method) {
  for (const json& row : rows)
    if (row["method"] == method) return row["l2"].get<double>();
  ADD_FAILURE() << "no " << method << " in " << rows;
  return 0;
}

// Metal walls, of which diffuse lights know nothing. All lights are gathered, so that a picture's
// pixels are those that the clamps were chosen by.
TEST(BenchVsgl, MoreLightsComeNearer) {
  const TemporaryFolder folder;
  const json result = runBench(
      "vsgl --scene study-diffuse --figures sampling --size 24x18 --pixels 100 --spp 64 --seed 3 "
      "--num-lights 4096 -o " +
      folder.path());
  const json& rows = result["sampling"];
  expectNumbers(rows, 1 + 5 * 7, {"lights", "gather", "l2_path", "ratio_path"});
  EXPECT_TRUE(rows[0]["l2"].is_null());
  std::map<std::string, std::map<int, double>> l2;  // by way and number
  for (size_t i = 1; i < rows.size(); ++i)
    l2[rows[i]["clusters"]][rows[i]["wanted"].get<int>()] = rows[i]["l2"].get<double>();
  for (const auto& [way, errors] : l2) {
    EXPECT_LT(errors.at(256), 0.6 * errors.at(4)) << way;
    EXPECT_LT(errors.at(1024), errors.at(64)) << way;
  }
  EXPECT_LT(l2["tree cut"][64], l2["sampling, bisection"][64]);
  expectPictures(folder, "vsgl",
                 {"sampling-study-diffuse-tree", "sampling-study-diffuse-fis",
                  "sampling-study-diffuse-points", "sampling-study-diffuse-path"});
}

TEST(BenchVsgl, TimesAndCuts) {
  const json result = runBench(
      "vsgl --scene study-ggx --figures time,cuts --size 32x24 --pixels 60 --spp 64 --num-lights "
      "2000");
  const json& time = result["time"];
  expectNumbers(time, 8, {"lights", "receivers", "shade", "mrays"});
  EXPECT_EQ(time[0]["l2"], 0);
  EXPECT_EQ(time[2]["shadows"], "maps");
  EXPECT_LT(time[2]["l2"], 0.5 * time[6]["l2"].get<double>()) << "maps, none";
  EXPECT_LT(time[5]["l2"], time[3]["l2"]) << "64 rays, 4 rays";
  EXPECT_LT(time[3]["mrays"], time[0]["mrays"]);
  EXPECT_EQ(time[7]["lights"], 2);
  const json& cuts = result["cuts"];
  expectNumbers(cuts, 21, {"gathered", "rays", "l2", "mean_ratio"});
  EXPECT_GT(cuts[6]["gathered"], cuts[0]["gathered"]);
}

TEST(BenchVmf, DataAndBounces) {
  const TemporaryFolder folder;
  const json result = runBench(
      "vmf --scene teapot-32 --detail 0.05 --pixels 1 --size 32x24 --spp 32 "
      "--figures table1,hash,1 -o " +
      folder.path());
  const json& table = result["table1"];
  expectNumbers(table, 1, {"vertices", "density", "mb", "file_mb", "masks", "seconds", "fps"});
  EXPECT_EQ(table[0]["paper_mb"], 413.3);
  const json& hash = result["hash"];
  expectNumbers(hash, 1, {"mrecords", "density", "slots", "displaced_mb", "rows_mb"});
  EXPECT_GE(hash[0]["slots"], 1);
  const json& bounces = result["figure1"];
  expectNumbers(bounces, 3, {"mean_ratio"});  // so coarse a mesh loses bounces
  EXPECT_NEAR(bounces[0]["mean_ratio"].get<double>(), 1, 0.08) << "direct light";
  expectPictures(folder, "vmf", {"figure1-teapot-32-0", "figure1-teapot-32-2-path"});
}

TEST(BenchVmf, ScatteringComesNearerWithRays) {
  const TemporaryFolder folder;
  const json rows = runBench(
      "vmf --scene teapot-32 --detail 0.05 --pixels 1 --size 32x24 --spp 16 --figures 3 -o " +
      folder.path())["figure3"];
  expectNumbers(rows, 5,
                {"mrays", "l2", "mean_ratio", "l2_converged", "mean_converged", "l2_bounces",
                 "mean_bounces"});
  for (size_t i = 0; i < 3; ++i) {
    const double ratio = std::pow(4, i);
    const json &row = rows[2 + i], &gathered = rows[0];
    EXPECT_NEAR(row["mrays"].get<double>() / gathered["mrays"].get<double>(), ratio, 0.06 * ratio);
  }
  EXPECT_LT(rows[4]["l2_converged"], 0.5 * rows[2]["l2_converged"].get<double>());
  EXPECT_LT(rows[4]["l2_bounces"], 0.5 * rows[2]["l2_bounces"].get<double>());
  EXPECT_NEAR(rows[4]["mean_bounces"].get<double>(), 1, 0.02);
  expectPictures(folder, "vmf", {"figure3-teapot-32-gathered"});
}

TEST(BenchVmf, WantsLightFromInfinity) {
  const ProgramResult r =
      runProgram("bench vmf --figures 4 --scene cornell --detail 0.05 --size 16x12");
  EXPECT_EQ(r.exitCode, 2);
  EXPECT_NE(r.err.find("cornell: pictures of transfer need light from infinity"), std::string::npos)
      << r.err;
}

TEST(BenchCuts, DataAndError) {
  const TemporaryFolder folder;
  const json result = runBench(
      "cuts --scene statue --detail 0.05 --size 32x24 --spp 32 --num-lights 2048 "
      "--figures 9,10,sigma -o " +
      folder.path());
  const json& data = result["figure9"];
  expectNumbers(data, 2, {"vertices", "seconds", "mrays", "mb", "cut", "rms", "bytes"});
  EXPECT_LT(data[0]["rms"], 0.2);
  EXPECT_LT(data[1]["bytes"], 4);
  EXPECT_TRUE(data[0]["gain"].is_null());
  EXPECT_GT(data[1]["fps512"], 0);
  const json& error = result["figure10"];
  expectNumbers(error, 10, {"nodes", "l2", "mean_ratio"});
  EXPECT_LT(error[6]["l2"], error[0]["l2"]) << "512 nodes, 64 nodes";
  EXPECT_NEAR(error[6]["mean_ratio"].get<double>(), 1, 0.03);
  const json& sigma = result["sigma"];
  expectNumbers(sigma, 4, {"sigma", "cut", "rms", "l2", "mean_ratio"});
  EXPECT_GT(sigma[0]["l2"], sigma[3]["l2"]);
  EXPECT_LT(sigma[0]["cut"], sigma[3]["cut"]);
  expectPictures(folder, "cuts", {"figure10-statue-path", "figure10-statue-512"});
}

TEST(BenchCuts, ClustersAndWavelets) {
  const TemporaryFolder folder;
  const json result =
      runBench("cuts --scene statue --detail 0.05 --num-lights 1024 --pixels 32 --figures 5,8 -o " +
               folder.path());
  const json& clusters = result["figure5"];
  expectNumbers(clusters, 3, {"beta", "spread", "visibility", "cut", "rms", "light"});
  EXPECT_EQ(clusters[0]["metric"], "geometric");
  EXPECT_LT(clusters[0]["spread"], clusters[2]["spread"]) << "by places, by visibility";
  EXPECT_GT(clusters[0]["visibility"], clusters[2]["visibility"]);
  const json& schemes = result["figure8b"];
  expectNumbers(schemes, 12, {"sigma", "cut", "rms", "cut_front", "rms_front"});
  EXPECT_TRUE(schemes[0]["gain"].is_null());
  EXPECT_GT(schemes[2]["gain"], 0) << "data-driven";
  EXPECT_GT(schemes[2]["gain_rms"], schemes[2]["gain"]) << "its error is lower, too";
  EXPECT_GT(schemes[0]["cut"], schemes[6]["cut"]) << "sigma 1.5, sigma 3";
  EXPECT_EQ(schemes[3]["cut"], clusters[0]["cut"]) << "sigma 2";
  const json& wavelets = result["figure8a"];
  expectNumbers(wavelets, 30, {"sigma", "terms", "rms", "wavelets", "more"});
  for (size_t tree = 0; tree < 30; tree += 6) {
    EXPECT_GT(wavelets[tree]["rms"], wavelets[tree + 4]["rms"]);
    EXPECT_EQ(wavelets[tree + 5]["rms"], 0) << "sigma 0";
    EXPECT_EQ(wavelets[tree + 5]["wavelets"], wavelets[5]["wavelets"]) << "whatever the tree";
  }
  EXPECT_GE(wavelets[5]["terms"], wavelets[5]["wavelets"]) << "quad tree";
  expectPictures(folder, "cuts", {"figure5-statue-geometric", "figure5-statue-data-driven"});
  EXPECT_TRUE(std::filesystem::exists(folder / "figure8a-statue.svg"));
}

TEST(BenchCuts, MaterialsOfOneVisibility) {
  const TemporaryFolder folder;
  const json result = runBench(
      "cuts --scene statue --detail 0.05 --camera bust --size 24x18 --spp 64 --num-lights 1024 "
      "--figures 6 -o " +
      folder.path());
  const json& rows = result["figure6"];
  expectNumbers(rows, 8, {"l2", "mean_ratio", "fps"});
  EXPECT_EQ(rows[0]["material"], "matt");
  for (const json& row : rows) {  // of a mesh this coarse a few percent are lost
    EXPECT_NEAR(row["mean_ratio"].get<double>(), 1, 0.1) << row;
    EXPECT_LT(row["l2"], 0.3) << row;
  }
  expectPictures(folder, "cuts",
                 {"figure6-statue-ward-cuts", "figure6-statue-ward-path",
                  "figure6-statue-star-cuts", "figure6-statue-bump-cuts"});
}

TEST(BenchCuts, LocalLights) {
  const TemporaryFolder folder;
  const json result = runBench(
      "cuts --scene cornell --detail 0.05 --size 32x24 --num-lights 512 --spp 32 --figures "
      "7,9-local -o " +
      folder.path());
  const json& bounce = result["figure7"];
  expectNumbers(bounce, 2, {"l2", "mean_ratio", "seconds"});
  EXPECT_NEAR(bounce[0]["mean_ratio"].get<double>(), 1, 0.05) << "direct";
  EXPECT_NEAR(bounce[1]["mean_ratio"].get<double>(), 1, 0.15) << "few samples";
  expectPictures(folder, "cuts", {"figure7-cornell-direct-cuts", "figure7-cornell-bounce-path"});
  const json& data = result["figure9_local"];
  expectNumbers(data, 1,
                {"vertices", "seconds", "cpu", "mrays", "mb", "cut", "rms", "fps128", "cpu128",
                 "fps256", "cpu256", "fps512", "cpu512"});
  EXPECT_LT(data[0]["rms"], 0.2);
  EXPECT_GT(data[0]["fps128"], 0);
}

TEST(BenchVsl, MethodsSideBySide) {
  const TemporaryFolder folder;
  const json result = runBench("vsl --scene study-ggx --figures 1,2,6,7" +
                               tinyVsl("16x12", 300, 400) + "-o " + folder.path());
  const json& first = result["figure1"];
  expectNumbers(first, 3, {"seconds", "l2", "mean_ratio"});
  expectNumbers(result["figure2"], 5, {"seconds", "l2", "mean_ratio"});
  expectNumbers(result["figure6"], 3, {"l2", "mean_ratio"});
  expectNumbers(result["figure7"], 3, {"l2", "mean_ratio"});
  const double vpl = l2Of(first, "VPL, best clamp"), vsl = l2Of(first, "VSL, our defaults");
  EXPECT_LT(vsl, 0.7 * vpl);
  EXPECT_LT(l2Of(first, "VSL as in the paper"), vpl);
  // Light that all pictures share makes the error less; figure 7 has that of figure 1.
  EXPECT_LT(l2Of(result["figure6"], "VPL, best clamp"), vpl);
  EXPECT_EQ(l2Of(result["figure7"], "VSL, our defaults"), vsl);
  EXPECT_LE(l2Of(result["figure2"], "glossy VPL, best clamp"),
            l2Of(result["figure2"], "glossy VPL, no clamp") + 1e-9);
  expectPictures(folder, "vsl",
                 {"figure1-study-ggx-reference", "figure1-study-ggx-missing",
                  "figure2-study-ggx-vpl-unclamped", "figure6-study-ggx-reference",
                  "figure7-study-ggx-vsl-signed", "figure7-study-ggx-vsl-absolute"});
  for (const char* name : {"figure1-study-ggx-vpl-clamped.exr", "figure1-study-ggx-vsl.exr",
                           "figure6-study-ggx-vsl-paper.exr"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

TEST(BenchVsl, CurvesOfSeveralScenes) {
  const std::string arguments =
      "vsl --figures 8 --scene study-diffuse" + tinyVsl("16x12", 600, 150);
  const json result = runBench(arguments + "--scene study-ggx");
  const json& columns = result["figure8_columns"];
  ASSERT_EQ(columns.size(), 4u) << columns;  // 500 and all, twice
  for (const json& row : columns) EXPECT_GT(row["vsl_l2"], 0) << row;
  EXPECT_EQ(columns[1]["columns"], 600);
  EXPECT_TRUE(columns[0]["cosine_l2"].is_number());
  expectNumbers(result["figure8_radius"], 12, {"vsl_l2", "vsl_ratio", "cosine_l2", "cosine_ratio"});
  EXPECT_EQ(result["figure8_radius"][5]["factor"], "automatic");
  const json& clamp = result["figure8_clamp"];
  expectNumbers(clamp, 24, {"vpl_l2", "vpl_ratio", "glossy_l2"});
  EXPECT_LT(clamp[0]["vpl_ratio"], clamp[11]["vpl_ratio"]) << "tighter clamps lose more";
  const json one = runBench(arguments + "--threads 1")["figure8_columns"];
  EXPECT_EQ(one, json({columns[0], columns[1]})) << "depends on threads, or on other scenes";
}

TEST(BenchVsl, BoxesOfItsOwn) {
  const TemporaryFolder folder;
  const json result =
      runBench("vsl --figures 4,5" + tinyVsl("32x24", 1500, 150) + "-o " + folder.path());
  expectNumbers(result["figure4"], 3, {"l2", "mean_ratio"});
  EXPECT_LT(l2Of(result["figure4"], "VSL, planar"), l2Of(result["figure4"], "VSL, cosine"));
  const json& sampling = result["figure5"];
  expectNumbers(sampling, 4, {"noise", "mean_ratio", "seconds"});
  EXPECT_EQ(sampling[0]["sampling"], "cone alone");
  for (size_t i = 1; i < sampling.size(); ++i) {
    EXPECT_LT(sampling[i]["noise"], sampling[0]["noise"].get<double>() / 1.3) << sampling[i];
    EXPECT_NEAR(sampling[i]["mean_ratio"].get<double>(), 1, 0.15) << sampling[i];
  }
  EXPECT_LT(sampling[3]["noise"], sampling[2]["noise"]) << "more samples, less noise";
  expectPictures(folder, "vsl",
                 {"figure4-study-corners-reference", "figure4-study-corners-vsl-planar",
                  "figure5-study-ward-cone", "figure5-study-ward-exact"});
}

const std::string kTinySglc =
    " --scene study-ggx --detail 0.2 --size 24x18 --pixels 80 --num-lights 2000 ";

// The rows of a method (and, where it is given, of a bound).
std::vector<json> rowsOf(const json& rows, const std::string& key, const std::string& value) {
  std::vector<json> found;
  for (const json& row : rows)
    if (row[key] == value) found.push_back(row);
  EXPECT_FALSE(found.empty()) << key << " " << value << " in " << rows;
  return found;
}
double number(const json& row, const std::string& key) {
  EXPECT_TRUE(row[key].is_number()) << key << " in " << row;
  return row[key].is_number() ? row[key].get<double>() : std::nan("");
}

TEST(BenchSglc, TableLayersBoundsAndFloors) {
  const TemporaryFolder folder;
  const json result =
      runBench("sglc --figures table2,4,6,floors" + kTinySglc + "-o " + folder.path());
  const json& table = result["table2"];
  for (const char* method : {"sglc, shared", "sglc, unbiased", "sglc, paper", "sglc, paper, E_c"}) {
    const json row = rowsOf(table, "method", method).at(0);
    EXPECT_LT(number(row, "l2"), 0.1) << row;
    EXPECT_NEAR(number(row, "mean_ratio"), 1, 0.03) << row;
    EXPECT_GT(number(row, "visited_per_pixel"), 0) << row;
    EXPECT_TRUE(row["paper_seconds"].is_null()) << "a scene that the paper does not have: " << row;
  }
  for (const char* method : {"mrcs", "richvpl, cube", "richvpl, vmf"})
    EXPECT_EQ(rowsOf(table, "method", method).size(), 1u) << method;
  const double all = number(rowsOf(table, "method", "every light").at(0), "rays_per_pixel");
  const json scene = result["table2_scenes"].at(0);
  EXPECT_GT(number(scene, "glossy_lights"), 0);
  EXPECT_LE(all, 1.1 * (number(scene, "diffuse_lights") + number(scene, "glossy_lights") +
                        number(scene, "direct")));
  double shares = 0;
  for (const json& row : rowsOf(result["figure4"], "method", "sglc, shared"))
    shares += number(row, "share");
  EXPECT_NEAR(shares, 1, 0.02) << result["figure4"];
  const std::vector<json> strict = rowsOf(result["figure6"], "bound", "E_c"),
                          loose = rowsOf(result["figure6"], "bound", "E_a");
  ASSERT_EQ(strict.size(), loose.size());
  for (size_t i = 0; i < strict.size(); ++i)
    EXPECT_GE(number(strict[i], "rays_per_pixel"), number(loose[i], "rays_per_pixel"));
  EXPECT_LT(number(loose.back(), "l2"), number(loose.front(), "l2")) << "smaller thresholds";
  expectNumbers(result["floors"], 3, {"mrays_per_second", "mshadings_per_second", "ratio"});
  expectPictures(folder, "sglc",
                 {"table2-study-ggx-sglc-shared", "figure4-study-ggx-sglc-shared-layers-dd",
                  "figure4-study-ggx-sglc-paper-layers-cost", "figure6-study-ggx-sglc-paper-cost"});
}

TEST(BenchSglc, CurvesAndGrowth) {
  const TemporaryFolder folder;
  const std::string arguments = "sglc --figures 8,9a,9b" + kTinySglc;
  const json result = runBench(arguments + "-o " + folder.path());
  for (const char* method : {"sglc, unbiased", "sglc, paper"}) {
    const std::vector<json> points = rowsOf(result["figure8"], "method", method);
    ASSERT_GE(points.size(), 3u);
    EXPECT_LT(number(points.back(), "l2"), number(points.front(), "l2")) << method;
  }
  const json ours = rowsOf(result["figure8_equal"], "method", "sglc, shared").at(0);
  EXPECT_EQ(number(ours, "visited_ratio"), 1) << ours;
  for (const json& row : rowsOf(result["figure9"], "method", "every light"))
    EXPECT_NEAR(number(row, "rays"), 1, 0.15) << row;
  EXPECT_EQ(rowsOf(result["figure9_lights"], "method", "sglc, paper").size(), 3u);
  EXPECT_EQ(rowsOf(result["figure9_pixels"], "method", "sglc, paper").size(), 4u);
  // At the error of the whole, which has it at its defaults.
  for (const char* table : {"figure9_lights", "figure9_pixels"}) {
    const json equal = rowsOf(result[table], "method", "sglc, shared, equal l2").back(),
               whole = rowsOf(result[table], "method", "sglc, shared").back();
    EXPECT_EQ(number(equal, "l2"), number(whole, "l2")) << table;
    EXPECT_NEAR(number(equal, "rays_per_pixel"), number(whole, "rays_per_pixel"), 1e-3) << table;
  }
  for (const char* name : {"figure8-study-ggx-time.svg", "figure9_lights-study-ggx.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
}

TEST(BenchSglc, OnlyTheMethodsAskedFor) {
  const json result = runBench("sglc --figures table2 --methods sglc-unbiased" + kTinySglc);
  EXPECT_EQ(result["table2"].size(), 3u) << "shared, unbiased, every light: " << result["table2"];
  EXPECT_NE(runProgram("bench sglc --methods sglc-unbiased,lightcut").err.find("'lightcuts'"),
            std::string::npos);
  EXPECT_NE(runProgram("bench vsl --methods lightcuts").err.find("sglc has"), std::string::npos);
}

TEST(BenchSglc, Frames) {
  const TemporaryFolder folder;
  const json frames =
      runBench("sglc --figures frames" + kTinySglc + "-o " + folder.path())["frames"];
  ASSERT_EQ(frames.size(), 25u) << "and their means";
  EXPECT_TRUE(frames[0]["change"].is_null()) << "there is nothing before the first";
  const json& mean = frames.back();
  double l2 = 0;
  for (size_t i = 0; i + 1 < frames.size(); ++i) l2 += number(frames[i], "l2") / 24;
  EXPECT_NEAR(number(mean, "l2"), l2, 1e-9);
  EXPECT_LT(l2, 0.1);
  EXPECT_GT(number(mean, "change_every_light"), 0);
  EXPECT_GT(number(mean, "change_of_error"), 0);
  EXPECT_LT(number(mean, "change_of_error"), 1.7 * l2) << "1.41 where errors are independent";
  EXPECT_TRUE(std::filesystem::exists(folder / "frames-study-ggx-default-change.png"));
}

}  // namespace
}  // namespace lobelia
