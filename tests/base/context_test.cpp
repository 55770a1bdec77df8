#include "lobelia/base/context.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

struct Recorder : Listener {
  void message(Severity severity, std::string_view text) override {
    messages.emplace_back(severity, text);
  }
  void progress(std::string_view stage, double fraction) override {
    stages.emplace_back(stage, fraction);
  }
  std::vector<std::pair<Severity, std::string>> messages;
  std::vector<std::pair<std::string, double>> stages;
};

TEST(Context, PassesMessagesAndProgressOn) {
  Recorder recorder;
  const Context context(&recorder);
  context.warning("odd");
  context.progress("lights", 0.5);
  ASSERT_EQ(recorder.messages.size(), 1u);
  EXPECT_EQ(recorder.messages[0], std::pair(Severity::warning, std::string("odd")));
  ASSERT_EQ(recorder.stages.size(), 1u);
  EXPECT_EQ(recorder.stages[0], std::pair(std::string("lights"), 0.5));
  Context().info("nobody listens");
}

TEST(Context, CountsFromManyThreads) {
  Context context;
  parallelFor(1000, 1, [&](size_t i) { context.statistics.addCount("rays", i); });
  EXPECT_EQ(context.statistics.count("rays"), 999u * 1000 / 2);
  EXPECT_EQ(context.statistics.count("none"), 0u);
  context.statistics.setValue("threshold", 1);
  context.statistics.setValue("threshold", 2);
  EXPECT_EQ(context.statistics.value("threshold"), 2);
}

TEST(Context, StageTimerAddsUp) {
  Context context;
  { const StageTimer timer(context, "load"); }
  const double once = context.statistics.seconds("load");
  EXPECT_GT(once, 0);
  { const StageTimer timer(context, "load"); }
  EXPECT_GT(context.statistics.seconds("load"), once);
}

TEST(Context, CancelIsSeen) {
  Context context;
  EXPECT_FALSE(context.cancelled());
  context.cancel();
  EXPECT_TRUE(context.cancelled());
}

}  // namespace
}  // namespace lobelia
