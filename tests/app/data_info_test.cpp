// `lobelia info` on what `lobelia precompute` wrote.
#include <nlohmann/json.hpp>

#include "app/block_scene.h"
#include "app/command_line.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::expectFailure;
using test::ProgramResult;
using test::runProgram;

class DataInfo : public testing::Test {
 protected:
  DataInfo() { test::writeText(folder_ / "scene.xml", test::kBlockScene); }
  // The statistics of making the data.
  json make(const std::string& options) const {
    const ProgramResult r =
        runProgram("precompute " + (folder_ / "scene.xml") + " " + options + " --quiet -o " +
                   data_ + " --stats " + (folder_ / "stats.json"));
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return json::parse(test::readText(folder_ / "stats.json"));
  }
  json described() const {
    const ProgramResult r = runProgram("info --json " + data_);
    EXPECT_EQ(r.exitCode, 0) << r.err;
    return json::parse(r.out);
  }
  // Whatever byte is another.
  void expectDamageIsFound() const {
    const std::string good = test::readText(data_);
    for (const size_t at : {size_t{3}, size_t{14}, size_t{40}, good.size() / 2, good.size() - 1}) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ 4);
      test::writeText(data_, bad);
      expectFailure("info " + data_, 3, data_);
    }
    for (const size_t size : {size_t{20}, size_t{60}, good.size() - 9}) {
      test::writeText(data_, good.substr(0, size));
      expectFailure("info " + data_, 3, data_);
    }
  }

  const test::TemporaryFolder folder_;
  const std::string data_ = folder_ / "data";
};

TEST_F(DataInfo, OfTransfer) {
  const json stats =
      make("--method vmf --directions 162 --rays 4 --subdivide 0 --bounces 1 --lobes materials");
  const json info = described();
  EXPECT_EQ(info["data"], data_);
  EXPECT_EQ(info["kind"], "vmf-transfer");
  EXPECT_EQ(info["method"], "vmf");
  EXPECT_EQ(info["scene_hash"].get<std::string>().size(), 16u);
  for (const char* key : {"vertices", "directions", "passes", "classes", "records", "bytes"})
    EXPECT_EQ(info[key], stats["transfer"][key]) << key;
  EXPECT_EQ(info["classes"], 2);
  EXPECT_EQ(info["file_bytes"], stats["memory"]["file_bytes"]);
  const ProgramResult text = runProgram("info " + data_);
  EXPECT_EQ(text.exitCode, 0) << text.err;
  EXPECT_NE(text.out.find("kind         vmf-transfer\n"), std::string::npos) << text.out;
  expectFailure("info --design x.xml " + data_, 2, "not a scene");
  expectDamageIsFound();
}

TEST_F(DataInfo, OfCuts) {
  const json stats =
      make("--method cuts --light surfaces --samples 256 --clusters 8 --subdivide 0");
  const json info = described();
  EXPECT_EQ(info["kind"], "visibility-cuts");
  EXPECT_EQ(info["light"], "surfaces");
  EXPECT_EQ(info["samples"], 256);
  EXPECT_EQ(info["vertices"], stats["counts"]["vertices"]);
  EXPECT_EQ(info["cut_nodes"], stats["counts"]["cut_nodes"]);
  EXPECT_EQ(info["file_bytes"], stats["memory"]["file_bytes"]);
  expectDamageIsFound();
}

TEST_F(DataInfo, OfOtherFilesOfOurs) {
  const ProgramResult r = runProgram(std::string(test::kSmall) + "--num-lights 100 --save-lights " +
                                     data_ + " -o " + (folder_ / "x.exr"));
  ASSERT_EQ(r.exitCode, 0) << r.err;
  expectFailure("info " + data_, 3, "virtual-lights");
}

}  // namespace
}  // namespace lobelia
