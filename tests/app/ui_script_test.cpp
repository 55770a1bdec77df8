// Scripts of what a hand does at the window.
#include "lobelia/app/viewer/ui_script.h"

#include <gtest/gtest.h>

#include "app/command_line.h"

namespace lobelia::test {
namespace {

std::vector<app::UiStep> read(const std::string& text) {
  const std::string file = testing::TempDir() + "/hand.script";
  writeText(file, text);
  return app::readUiScript(file);
}

std::string problem(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(UiScript, ReadsWhatAHandDoes) {
  using Kind = app::UiStep::Kind;
  const auto steps = read(
      "# a comment\n\nclick \"Add point\"   # press it\n  type Files/design \"my design.xml\"\n"
      "slide roughness 0.75\ndrag-picture alt+left 0.1,0.2 0.9,0.8\nkey ctrl+shift+z\n"
      "wheel 0.5,0.5 -3\nresize 800x0\ndrop sky.hdr\nframes 3\nwait\n");
  ASSERT_EQ(steps.size(), 10u);
  EXPECT_EQ(steps[0].kind, Kind::click);
  EXPECT_EQ(steps[0].label, "Add point");
  EXPECT_EQ(steps[0].where.line, 3);
  EXPECT_EQ(steps[1].text, "my design.xml");
  EXPECT_FLOAT_EQ(steps[2].amount, 0.75f);
  EXPECT_TRUE(steps[3].alt);
  EXPECT_EQ(steps[3].button, 0);
  EXPECT_FLOAT_EQ(steps[3].to.x, 0.9f);
  EXPECT_TRUE(steps[4].ctrl && steps[4].shift);
  EXPECT_EQ(steps[4].text, "z");
  EXPECT_FLOAT_EQ(steps[5].amount, -3);
  EXPECT_EQ(steps[6].size.y, 0);
  EXPECT_TRUE(steps[7].text.ends_with("/sky.hdr")) << "beside the script";
  EXPECT_EQ(steps[8].count, 3);
  EXPECT_EQ(steps[9].kind, Kind::wait);
}

TEST(UiScript, SaysWhichLineIsWrong) {
  EXPECT_NE(problem("wait\nclik x\n").find(":2: unknown command 'clik'; did you mean 'click'?"),
            std::string::npos)
      << problem("wait\nclik x\n");
  EXPECT_NE(problem("slide a\n").find("slide LABEL SHARE"), std::string::npos);
  EXPECT_NE(problem("slide a 1.5\n").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(problem("slide a nan\n").find("from 0 to 1"), std::string::npos);
  EXPECT_NE(problem("click \"a\n").find("without its second"), std::string::npos);
  EXPECT_NE(problem("drag-picture lft 0,0 1,1\n").find("did you mean 'left'"), std::string::npos);
  EXPECT_NE(problem("ui-screenshot a.jpg\n").find(".png"), std::string::npos);
  EXPECT_NE(problem("resize 99999x1\n").find("16384"), std::string::npos);
  EXPECT_NE(problem("click-picture 0.5\n").find("0.5,0.25"), std::string::npos);
}

}  // namespace
}  // namespace lobelia::test
