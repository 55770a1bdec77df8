// `lobelia view` in a real window, on a display of its own (Xvfb and software OpenGL). Skipped
// where Xvfb is not installed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "app/command_line.h"
#include "app/panel_window.h"
#include "lobelia/io/image_io.h"
#include "support/virtual_display.h"

namespace lobelia::test {
namespace {

class WindowReal : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_ / name; }
  // before: what stands before the program's name, as variables of its environment.
  ProgramResult run(const std::string& before, const std::string& options) const {
    // Leaks are sought without a window (window_panels_test.cpp): GLFW unloads the driver in the
    // end, and what Mesa keeps in its statics then counts as lost, by a library that no suppression
    // can name any more.
    const std::string command = before + " ASAN_OPTIONS=detect_leaks=0 " + LOBELIA_PROGRAM +
                                " view " + file("scene.xml") + " " + options + " >" + file("out") +
                                " 2>" + file("err") + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readText(file("out")),
            readText(file("err"))};
  }
  ProgramResult runScript(const std::string& script, const std::string& options = "") const {
    writeText(file("hand.script"), script);
    return run(
        "env DISPLAY=" + display_->name(),
        "--size 640x400 --spp 1 --threads 2 --ui-script " + file("hand.script") + " " + options);
  }
  void SetUp() override { writeText(file("scene.xml"), kPanelScene); }
  static void SetUpTestSuite() { display_ = std::make_unique<VirtualDisplay>(); }
  static void TearDownTestSuite() { display_.reset(); }
  static bool haveDisplay() { return !display_->name().empty(); }

  static inline std::unique_ptr<VirtualDisplay> display_;

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
  if (!haveDisplay()) GTEST_SKIP() << "Xvfb is not installed, or does not start";
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
  if (!haveDisplay()) GTEST_SKIP() << "Xvfb is not installed, or does not start";
  const ProgramResult r = runScript("frames 2\nclick \"load envirnoment\"\n");
  EXPECT_EQ(r.exitCode, 3);
  EXPECT_NE(r.err.find("hand.script:2"), std::string::npos) << r.err;
}

TEST_F(WindowReal, UnknownCamerasAndScenesEndItAsElsewhere) {
  if (!haveDisplay()) GTEST_SKIP() << "Xvfb is not installed, or does not start";
  const ProgramResult r = runScript("wait\n", "--camera nowhere");
  EXPECT_EQ(r.exitCode, 2) << r.err;
  EXPECT_NE(r.err.find("nowhere"), std::string::npos) << r.err;
  writeText(file("scene.xml"), "<scene version=\"3.0.0\"><shape type=\"nothing\"/></scene>");
  EXPECT_EQ(runScript("wait\n").exitCode, 3);
}

TEST_F(WindowReal, AnOpenGlTooOldIsNamed) {
  if (!haveDisplay()) GTEST_SKIP() << "Xvfb is not installed, or does not start";
  setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
  const ProgramResult r = runScript("wait\n");
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  EXPECT_EQ(r.exitCode, 1);
  EXPECT_NE(r.err.find("OpenGL 3.0"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace lobelia::test
