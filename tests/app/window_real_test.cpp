// `lobelia view` in a real window, on a display of its own (Xvfb and software OpenGL). Skipped
// where xvfb-run is not installed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "app/command_line.h"
#include "app/panel_window.h"
#include "lobelia/io/image_io.h"

namespace lobelia::test {
namespace {

class WindowReal : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_ / name; }
  // before: what stands before the program's name.
  ProgramResult run(const std::string& before, const std::string& options) const {
    // xvfb-run has exit codes of its own for troubles with its display's files.
    writeText(file("run.sh"), std::string(LOBELIA_PROGRAM) + " view " + file("scene.xml") + " " +
                                  options + " >" + file("out") + " 2>" + file("err") +
                                  " </dev/null\necho $? >" + file("code") + "\n");
    const std::string command = before + " sh " + file("run.sh") + " >" + file("before") + " 2>&1";
    if (std::system(command.c_str()) == -1) return {};
    const std::string code = readText(file("code"));
    return {code.empty() ? -1 : std::stoi(code), readText(file("out")),
            readText(file("err")) + (code.empty() ? readText(file("before")) : "")};
  }
  ProgramResult runScript(const std::string& script, const std::string& options = "") const {
    writeText(file("hand.script"), script);
    return run(
        "xvfb-run -a -s '-screen 0 800x600x24'",
        "--size 640x400 --spp 1 --threads 2 --ui-script " + file("hand.script") + " " + options);
  }
  void SetUp() override { writeText(file("scene.xml"), kPanelScene); }
  static bool haveDisplay() { return std::system("command -v xvfb-run >/dev/null 2>&1") == 0; }

  TemporaryFolder folder_;
};

size_t distinct(const Film& film) {
  std::vector<float> values = film.layers.at("").values;
  std::sort(values.begin(), values.end());
  return static_cast<size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

TEST_F(WindowReal, WithoutADisplayItSaysSoAndWhatDrawsWithoutOne) {
  const ProgramResult r = run("env -u DISPLAY -u WAYLAND_DISPLAY", "");
  EXPECT_EQ(r.exitCode, 1);
  EXPECT_NE(r.err.find("--headless"), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
}

TEST_F(WindowReal, WhatDrawsFilesWantsHeadless) {
  for (const char* options : {"-o x.exr", "--script x", "--frames 2", "--crop 0,0,1,1"}) {
    expectFailure("view " + file("scene.xml") + " " + options, 2, "--headless");
  }
}

// One process for much, since a display takes seconds to start.
TEST_F(WindowReal, ShowsThePictureThroughResizesAndALostContext) {
  if (!haveDisplay()) GTEST_SKIP() << "xvfb-run is not installed";
  const ProgramResult r = runScript(
      "key Tab\nwait\nui-screenshot " + file("first.png") +
      "\nresize 0x0\nframes 3\nresize 1x1\n"
      "frames 3\nresize 500x300\nwait\nlose-context\nframes 2\nexpect \"made anew\"\nwait\n"
      "ui-screenshot " +
      file("again.png") +
      "\ndrop nothing.hdr\nwait\nexpect nothing.hdr\n"
      "minimise\nframes 2\nrestore\nframes 2\n");
  ASSERT_EQ(r.exitCode, 0) << r.err;
  const Film first = io::readFilm(file("first.png")), again = io::readFilm(file("again.png"));
  EXPECT_EQ(first.width, 640);
  EXPECT_EQ(first.height, 400);
  EXPECT_EQ(again.width, 500);
  EXPECT_EQ(again.height, 300);
  EXPECT_GT(distinct(first), 30u) << "a picture, not one colour";
  EXPECT_GT(distinct(again), 30u) << "after the context was lost, too";
}

TEST_F(WindowReal, ScriptsThatFailNameTheirLine) {
  if (!haveDisplay()) GTEST_SKIP() << "xvfb-run is not installed";
  const ProgramResult r = runScript("frames 2\nclick \"load envirnoment\"\n");
  EXPECT_EQ(r.exitCode, 3);
  EXPECT_NE(r.err.find("hand.script:2"), std::string::npos) << r.err;
}

TEST_F(WindowReal, UnknownCamerasAndScenesEndItAsElsewhere) {
  if (!haveDisplay()) GTEST_SKIP() << "xvfb-run is not installed";
  const ProgramResult r = runScript("wait\n", "--camera nowhere");
  EXPECT_EQ(r.exitCode, 2) << r.err;
  EXPECT_NE(r.err.find("nowhere"), std::string::npos) << r.err;
  writeText(file("scene.xml"), "<scene version=\"3.0.0\"><shape type=\"nothing\"/></scene>");
  EXPECT_EQ(runScript("wait\n").exitCode, 3);
}

TEST_F(WindowReal, AnOpenGlTooOldIsNamed) {
  if (!haveDisplay()) GTEST_SKIP() << "xvfb-run is not installed";
  setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
  const ProgramResult r = runScript("wait\n");
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  EXPECT_EQ(r.exitCode, 1);
  EXPECT_NE(r.err.find("OpenGL 3.0"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace lobelia::test
