// Renders of a small scene with their statistics, for tests of one gather strategy.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lobelia/io/image_io.h"
#include "support/run_program.h"

namespace lobelia::test {

class RenderTest : public testing::Test {
 protected:
  // Most of a small run is its start, and most of that the fits of lobes that Phong's do not take.
  static constexpr const char* kPhong = "render study-phong --detail 0.05 --quiet ";
  static constexpr const char* kMicrofacets = "render cornell --detail 0.05 --quiet ";

  Film render(const std::string& options, const std::string& name) {
    const std::string file = folder_ / (name + ".exr");
    const ProgramResult r =
        runProgram(scene_ + options + " -o " + file + " --stats " + (folder_ / (name + ".json")));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return io::readFilm(file);
  }
  nlohmann::json statistics(const std::string& name) {
    return nlohmann::json::parse(readText(folder_ / (name + ".json")));
  }
  // Wrong use, whose message mentions what would be right.
  void expectError(const std::string& options, const char* mentions) {
    const ProgramResult r =
        runProgram(scene_ + options + " --size 16x16 --spp 1 -o " + (folder_ / "x.exr"));
    EXPECT_EQ(r.exitCode, 2) << options;
    EXPECT_NE(r.err.find(mentions), std::string::npos) << r.err;
  }
  TemporaryFolder folder_;
  std::string scene_ = kPhong;
};

}  // namespace lobelia::test
