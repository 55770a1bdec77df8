// A precomputation that was stopped goes on and gives the same bits.
#include <gtest/gtest.h>

#include "lobelia/base/parallel.h"
#include "support/run_program.h"
#include "transfer/messages.h"
#include "transfer/small_transfer.h"

namespace lobelia::transfer {
namespace {

namespace fs = std::filesystem;

// Three blocks of vertices. One material, without an image: tables and records of what surfaces
// reflect take their time.
Scene scene() {
  Scene scene = test::glossyScene(22);
  scene.instances[1].material = scene.instances[0].material;
  scene.materials.resize(1);
  return scene;
}

TransferSettings quick() {
  TransferSettings settings = test::coarseTransfer();
  settings.directionLevel = 1, settings.rayLevel = 3, settings.maskLevel = 3;
  return settings;
}

class Resume : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Context context;
    whole_ = new TransferData(test::transferOf(scene(), quick(), context));
  }
  static void TearDownTestSuite() { delete whole_; }

  TransferSettings settings() const {
    TransferSettings settings = quick();
    settings.workFolder = path_;
    return settings;
  }
  // Runs until a stage has come so far; one block at a time.
  void runUntil(std::string_view stage, double fraction) {
    const ThreadLimit one(1);
    test::Messages messages;
    Context context(&messages);
    messages.onProgress = [&](std::string_view name, double done) {
      if (name == stage && done >= fraction) context.cancel();
    };
    EXPECT_THROW(test::transferOf(scene(), settings(), context), Cancelled) << stage;
  }
  size_t blocks() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(path_), {}));
  }
  // Goes on to the end; returns how many blocks were there.
  uint64_t goOn() {
    Context context(&messages_);
    test::expectSame(test::transferOf(scene(), settings(), context), *whole_);
    EXPECT_FALSE(fs::exists(path_));
    return context.statistics.count("blocks_resumed");
  }

  const test::TemporaryFolder temporary_;
  const std::string path_ = temporary_ / "work";
  test::Messages messages_;
  static inline TransferData* whole_ = nullptr;
};

TEST_F(Resume, AFolderChangesNothing) {
  ASSERT_GT(whole_->mesh.vertices.size(), 512u);
  ASSERT_GT(whole_->recordCount(), 0u);
  EXPECT_EQ(goOn(), 0u);
}

TEST_F(Resume, GoesOnAfterTheFirstBlock) {
  runUntil("rays and direct light", 0.1);
  EXPECT_EQ(blocks(), 3u) << "the mesh, rays and slices of a block";
  EXPECT_EQ(goOn(), 1u);
}

TEST_F(Resume, GoesOnAmongBounces) {
  runUntil("bounces", 0.1);
  const size_t count = (whole_->mesh.vertices.size() + 255) / 256;
  EXPECT_EQ(blocks(), 1 + 2 * count + 1);
  EXPECT_EQ(goOn(), count + 1);
}

TEST_F(Resume, GoesOnTwice) {
  runUntil("rays and direct light", 0.1);
  runUntil("bounces", 0.1);
  EXPECT_GT(goOn(), 1u);
}

TEST_F(Resume, DamagedBlocksAreMadeAgain) {
  runUntil("bounces", 0.1);
  for (const char* name : {"mesh", "pass0-00001", "rays-00000", "pass1-00000"}) {
    const std::string file = path_ + "/" + name + ".block";
    std::string text = test::readText(file);
    ASSERT_FALSE(text.empty()) << name;
    text[text.size() / 2] ^= 16;
    test::writeText(file, text);
  }
  EXPECT_EQ(goOn(), (whole_->mesh.vertices.size() + 255) / 256 - 2);
  EXPECT_EQ(messages_.warnings, 4u);
}

TEST_F(Resume, MoreBouncesGoOnFromFewer) {
  runUntil("bounces", 0.1);
  TransferSettings more = settings();
  more.bounces = 2;
  Context context;
  const TransferData data = test::transferOf(scene(), more, context);
  ASSERT_EQ(data.passes.size(), 3u);
  EXPECT_TRUE(test::sameRows(data.passes[1].glossy[0], whole_->passes[1].glossy[0]));
  EXPECT_GT(context.statistics.count("blocks_resumed"), 2u);
}

TEST_F(Resume, OtherSettingsAndScenesAreRefused) {
  runUntil("rays and direct light", 0.1);
  Context context;
  for (int other = 0; other < 3; ++other) {
    Scene changed = scene();
    TransferSettings s = settings();
    if (other == 0) s.directionLevel = 2;
    if (other == 1) s.maskTolerance = 0.02f;
    if (other == 2) changed.materials[0].alphaU = 31.f;
    EXPECT_THROW(test::transferOf(changed, s, context), InputError) << other;
  }
  EXPECT_EQ(blocks(), 3u);
  EXPECT_EQ(goOn(), 1u);
}

}  // namespace
}  // namespace lobelia::transfer
