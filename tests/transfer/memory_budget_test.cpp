#include "lobelia/transfer/memory_budget.h"

#include <gtest/gtest.h>

#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "transfer/messages.h"
#include "transfer/small_transfer.h"

namespace lobelia::transfer {
namespace {

constexpr uint64_t kMega = 1 << 20;

std::string refusal(const MemoryBudget& budget, const MemoryUse& now, const MemoryUse& added,
                    const VertexProgress& progress) {
  try {
    budget.require(now, added, progress);
  } catch (const RuntimeError& e) {
    return e.what();
  }
  return "";
}

TEST(MemoryBudget, CountsAllThatIsThere) {
  const MemoryUse use{2 * kMega, 3 * kMega, 4 * kMega, 5 * kMega};
  EXPECT_EQ(refusal(MemoryBudget(14 * kMega), use, {}, {"bounces", 8, 8, 0}), "");
  const std::string message = refusal(MemoryBudget(14 * kMega - 1), use, {}, {"bounces", 8, 8, 0});
  EXPECT_NE(message.find("--memory 14336K is too little"), std::string::npos) << message;
  EXPECT_NE(message.find("8 of 8 vertices (bounces)"), std::string::npos) << message;
  EXPECT_NE(message.find("--work, which keeps rays on the disk"), std::string::npos) << message;
}

TEST(MemoryBudget, ExpectsOfTheRestWhatHasBeenMade) {
  const MemoryUse now{kMega, 10 * kMega, 0, 0}, added{0, 10 * kMega, 0, 0};
  // A tenth is made: 101 megabytes in all, of which 90 are to come, and four fifths are sure.
  const VertexProgress tenth{"direct", 100, 1000, 0};
  EXPECT_EQ(refusal(MemoryBudget(84 * kMega), now, added, tenth), "");
  const std::string message = refusal(MemoryBudget(82 * kMega), now, added, tenth);
  EXPECT_NE(message.find(std::to_string(101 * 1024 + 1) + "K. Give more"), std::string::npos)
      << message;
  EXPECT_EQ(message.find("--work"), std::string::npos) << message;
}

TEST(MemoryBudget, CountsWhatLaterStagesNeedInAnyCase) {
  const MemoryUse now{kMega, 0, 0, 0};
  EXPECT_EQ(refusal(MemoryBudget(6 * kMega), now, {}, {"direct", 8, 8, 5 * kMega}), "");
  EXPECT_NE(refusal(MemoryBudget(5 * kMega), now, {}, {"direct", 8, 8, 5 * kMega})
                .find("would take about 6145K at least"),
            std::string::npos);
}

// 25 blocks; with one thread, 8 of them from all over the mesh come first.
TEST(MemoryBudget, ASceneThatCannotFitIsRefusedAfterItsFirstBlocks) {
  const ThreadLimit one(1);
  Scene scene = test::glossyScene(78);
  scene.instances[1].material = scene.instances[0].material;
  scene.materials.resize(1);
  TransferSettings settings = test::coarseTransfer();
  settings.directionLevel = 1, settings.rayLevel = 2, settings.subdivision = 0;
  test::Messages messages;
  Context context(&messages);
  const TransferData whole = test::transferOf(scene, settings, context);
  ASSERT_GT(whole.mesh.vertices.size(), 24u * 256);
  double most = 0;
  messages.onProgress = [&](std::string_view, double done) { most = std::max(most, done); };
  // Half of what the data alone take.
  settings.memoryBytes = whole.byteCount() / 2;
  EXPECT_THROW(test::transferOf(scene, settings, context), RuntimeError);
  EXPECT_LT(most, 0.4);
  EXPECT_GT(most, 0.3);
  // And the order in which blocks are made is seen nowhere.
  const ThreadLimit many(4);
  settings.memoryBytes = 0;
  test::expectSame(test::transferOf(scene, settings, context), whole);
}

}  // namespace
}  // namespace lobelia::transfer
