// Camera paths and turntables, as a user types them.
#include "lobelia/app/frames.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/moving_scene.h"
#include "lobelia/io/image_io.h"

namespace lobelia {
namespace {

using app::frameFile;
using test::ProgramResult;
using test::runProgram;
using test::TemporaryFolder;

TEST(FrameFile, NumbersGoWhereTheyAreAskedFor) {
  EXPECT_EQ(frameFile("a/b.exr", 7), "a/b.0007.exr");
  EXPECT_EQ(frameFile("a.d/b", 12345), "a.d/b.12345");
  EXPECT_EQ(frameFile("b-%04d.exr", 7), "b-0007.exr");
  EXPECT_EQ(frameFile("b%d.exr", 7), "b7.exr");
  EXPECT_EQ(frameFile("%03d/b.exr", 42), "042/b.exr");
  EXPECT_EQ(frameFile("100%.exr", 1), "100%.0001.exr");
  EXPECT_EQ(frameFile("5%s-%02d.png", 3), "5%s-03.png");
}

class Frames : public ::testing::Test {
 protected:
  ProgramResult render(const std::string& arguments) const {
    return runProgram("render " + scene_ + " --quiet --spp 2 --num-lights 16 " + arguments);
  }
  void expectUsage(const std::string& arguments, const std::string& mentions) const {
    const ProgramResult r = render(arguments + " -o " + (folder_ / "x.exr"));
    EXPECT_EQ(r.exitCode, 2) << arguments << "\n" << r.err;
    EXPECT_NE(r.err.find(mentions), std::string::npos) << arguments << "\nsaid: " << r.err;
  }
  void expectSame(const std::string& a, const std::string& b) const {
    const Film x = io::readFilm(folder_ / a), y = io::readFilm(folder_ / b);
    EXPECT_EQ(x.layers.at("").values, y.layers.at("").values) << a << " and " << b;
  }
  void expectDifferent(const std::string& a, const std::string& b) const {
    const Film x = io::readFilm(folder_ / a), y = io::readFilm(folder_ / b);
    EXPECT_NE(x.layers.at("").values, y.layers.at("").values) << a << " and " << b;
  }

  const TemporaryFolder folder_;
  const std::string scene_ = test::writeMovingScene(folder_);
};

TEST_F(Frames, AlongKeys) {
  const std::string outputs = " -o " + (folder_ / "f.exr") + " -o " + (folder_ / "p%02d.png") +
                              " --stats " + (folder_ / "s.json");
  const ProgramResult r = render("--frames 3" + outputs);
  ASSERT_EQ(r.exitCode, 0) << r.err;
  for (const char* name : {"f.0000.exr", "f.0001.exr", "f.0002.exr", "p00.png", "p01.png",
                           "p02.png", "s.0000.json", "s.0001.json", "s.0002.json"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.exr"));
  // The same as at their times, one by one.
  ASSERT_EQ(render("--time 2 -o " + (folder_ / "t2.exr")).exitCode, 0);
  ASSERT_EQ(render("--time 3 -o " + (folder_ / "t3.exr")).exitCode, 0);
  expectSame("f.0000.exr", "t2.exr");
  expectSame("f.0001.exr", "t3.exr");
  expectDifferent("f.0001.exr", "f.0002.exr");
  // A frame for itself, and a range.
  ASSERT_EQ(render("--frames 3 --frame 2 -o " + (folder_ / "alone.exr")).exitCode, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "alone.0001.exr"));
  expectSame("f.0002.exr", "alone.0002.exr");
  ASSERT_EQ(render("--frames 3 --frame 0-1 -o " + (folder_ / "part.exr")).exitCode, 0);
  expectSame("f.0001.exr", "part.0001.exr");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "part.0002.exr"));
  // Statistics are each frame's own.
  const auto stats = [&](const char* name) {
    return nlohmann::json::parse(test::readText(folder_ / name));
  };
  const auto first = stats("s.0000.json"), last = stats("s.0002.json");
  EXPECT_GT(first["seconds"]["accel"], 0);
  EXPECT_EQ(last["seconds"]["load"], 0);
  EXPECT_GT(last["counts"]["shadow_rays"], 0);
  EXPECT_LT(last["counts"]["shadow_rays"], 2 * first["counts"]["shadow_rays"].get<double>());
  EXPECT_EQ(io::readFilm(folder_ / "f.0002.exr").metadata.at("lobelia:frame"), "2");
}

TEST_F(Frames, ThroughNamedCameras) {
  for (const char* lights : {"glossy", "light"}) {
    const std::string method = std::string(" --lights ") + lights + " ";
    ASSERT_EQ(render(method + "--camera a,b,c --frames 5 -o " + (folder_ / "v.exr")).exitCode, 0);
    for (const auto& [frame, camera] :
         {std::pair{"v.0000.exr", "a"}, std::pair{"v.0004.exr", "c"}}) {
      const std::string still = std::string(camera) + ".exr";
      ASSERT_EQ(render(method + "--camera " + camera + " -o " + (folder_ / still)).exitCode, 0);
      expectSame(frame, still);
    }
    expectDifferent("v.0001.exr", "v.0002.exr");
  }
}

TEST_F(Frames, Turntable) {
  ASSERT_EQ(
      render("--camera a --turntable --frames 4 --lights path -o " + (folder_ / "t.exr")).exitCode,
      0);
  ASSERT_EQ(render("--camera a --lights path -o " + (folder_ / "a.exr")).exitCode, 0);
  ASSERT_EQ(render("--camera b --lights path -o " + (folder_ / "b.exr")).exitCode, 0);
  expectSame("t.0000.exr", "a.exr");
  // A quarter turn about y takes (0, 1, 6) to (6, 1, 0), where b stands and looks at the same.
  const Film quarter = io::readFilm(folder_ / "t.0001.exr"), b = io::readFilm(folder_ / "b.exr");
  const auto& x = quarter.layers.at("").values;
  const auto& y = b.layers.at("").values;
  double difference = 0, sum = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    difference += std::abs(static_cast<double>(x[i] - y[i]));
    sum += static_cast<double>(y[i]);
  }
  EXPECT_LT(difference, 0.05 * sum);
  expectDifferent("t.0002.exr", "t.0000.exr");
}

TEST_F(Frames, LightsAreMadeOnceAndSaved) {
  const std::string lights = folder_ / "set.lights";
  ASSERT_EQ(render("--frames 2 --save-lights " + lights + " -o " + (folder_ / "s.exr")).exitCode,
            0);
  ASSERT_EQ(render("--frames 2 --load-lights " + lights + " -o " + (folder_ / "l.exr")).exitCode,
            0);
  expectSame("s.0000.exr", "l.0000.exr");
  expectSame("s.0001.exr", "l.0001.exr");
}

// PNG files of all frames are tone-mapped by the first one's curve: a frame that is rendered alone
// has another one.
TEST_F(Frames, OneToneCurveForAll) {
  ASSERT_EQ(render("--camera a,c --frames 2 -o " + (folder_ / "p.png")).exitCode, 0);
  ASSERT_EQ(render("--camera a,c --frames 2 --frame 1 -o " + (folder_ / "q.png")).exitCode, 0);
  ASSERT_EQ(render("--camera a,c --frames 2 --frame 0 -o " + (folder_ / "q.png")).exitCode, 0);
  EXPECT_EQ(test::readText(folder_ / "p.0000.png"), test::readText(folder_ / "q.0000.png"));
  EXPECT_NE(test::readText(folder_ / "p.0001.png"), test::readText(folder_ / "q.0001.png"));
}

TEST_F(Frames, WrongUse) {
  expectUsage("--camera nobody", "there are moves, a, b, c");
  expectUsage("--camera a,b", "--frames");
  expectUsage("--camera a,,b --frames 2", "commas");
  expectUsage("--camera a,d --frames 2", "'d' is not in the scene");
  expectUsage("--camera a --frames 2", "does not move");
  expectUsage("--camera a,b --turntable --frames 2", "starts at one camera");
  expectUsage("--turntable", "--frames");
  expectUsage("--frame 1", "--frames");
  expectUsage("--frames 0", "--frames");
  expectUsage("--frames 3 --frame 3", "from 0 to 2");
  expectUsage("--frames 3 --frame 2-1", "from 0 to 2");
  expectUsage("--frames 3 --frame 1-", "from 0 to 2");
  expectUsage("--frames 3 --frame x", "from 0 to 2");
  expectUsage("--frames 2 -o " + (folder_ / "x.exr"), "twice");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.0000.exr"));
}

}  // namespace
}  // namespace lobelia
