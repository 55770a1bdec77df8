// Folders of finished work: what they give back, what they take for damaged, what they refuse.
#include "lobelia/transfer/work_folder.h"

#include <gtest/gtest.h>

#include "lobelia/base/error.h"
#include "support/run_program.h"
#include "transfer/messages.h"

namespace lobelia::transfer {
namespace {

namespace fs = std::filesystem;

class WorkFolderTest : public testing::Test {
 protected:
  static store::Writer blockOf(const WorkFolder& folder, float value) {
    store::Writer writer = folder.writer();
    writer.add("values", std::span<const float>(&value, 1));
    return writer;
  }
  static std::optional<float> valueOf(const WorkFolder& folder, const std::string& name) {
    const std::optional<store::Reader> found = folder.find(name);
    if (!found) return {};
    return found->get<float>("values").at(0);
  }
  // A folder with one block, of hash 5.
  void fill() {
    const WorkFolder folder(path_, 5, context_);
    folder.put("one", blockOf(folder, 1.5f));
  }
  void expectRefused(uint64_t hash, const std::string& mentions) {
    try {
      const WorkFolder folder(path_, hash, context_);
      ADD_FAILURE() << "was taken; should have been refused: " << mentions;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(mentions), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(path_), std::string::npos) << e.what();
    }
  }

  const test::TemporaryFolder temporary_;
  const std::string path_ = temporary_ / "a/work";
  test::Messages messages_;
  Context context_{&messages_};
};

TEST_F(WorkFolderTest, GivesBackWhatWasPut) {
  {
    const WorkFolder folder(path_, 5, context_);
    EXPECT_FALSE(folder.find("one"));
    folder.put("one", blockOf(folder, 1.5f));
    folder.put("two", blockOf(folder, 2.5f));
    EXPECT_EQ(valueOf(folder, "one"), 1.5f);
  }
  EXPECT_EQ(messages_.said("going on"), 0u);
  const WorkFolder again(path_, 5, context_);
  EXPECT_EQ(messages_.said("2 blocks are there"), 1u);
  EXPECT_EQ(valueOf(again, "one"), 1.5f);
  EXPECT_EQ(valueOf(again, "two"), 2.5f);
  EXPECT_FALSE(again.find("three"));
  again.put("one", blockOf(again, 3.5f));
  EXPECT_EQ(valueOf(again, "one"), 3.5f);
  EXPECT_EQ(messages_.warnings, 0u);
}

TEST_F(WorkFolderTest, IsOfOneSceneAndOneChoiceOfSettings) {
  fill();
  expectRefused(6, "of another scene or of other settings; delete the folder");
  EXPECT_EQ(valueOf(WorkFolder(path_, 5, context_), "one"), 1.5f) << "nothing was touched";
}

TEST_F(WorkFolderTest, ADamagedBlockIsNoneWithAWarning) {
  fill();
  const std::string file = WorkFolder(path_, 5, context_).fileOf("one");
  const std::string good = test::readText(file);
  std::string bad = good;
  bad[bad.size() - 12] ^= 1;
  for (const std::string& text : {bad, good.substr(0, good.size() - 20), std::string()}) {
    test::writeText(file, text);
    messages_.clear();
    const WorkFolder folder(path_, 5, context_);
    EXPECT_FALSE(folder.find("one"));
    EXPECT_EQ(messages_.warnings, 1u);
    EXPECT_EQ(messages_.said("one.block"), 1u);
    folder.put("one", blockOf(folder, 4.5f));
    EXPECT_EQ(valueOf(folder, "one"), 4.5f);
  }
}

TEST_F(WorkFolderTest, OtherThingsInItAreRefusedAndKept) {
  fill();
  for (const char* name : {"/notes.txt", "/picture.block"}) {
    test::writeText(path_ + name, "mine");
    test::writeText(path_ + "/x.block.tmp-1", "of a run");
    expectRefused(5, name);
    EXPECT_EQ(test::readText(path_ + name), "mine");
    EXPECT_TRUE(fs::exists(path_ + "/x.block.tmp-1"));
    fs::remove(path_ + name);
  }
  store::Writer("visibility-cuts", 1, 5).save(path_ + "/scene.block");
  expectRefused(5, "scene.block");
}

TEST_F(WorkFolderTest, LeftoversOfAKilledRunGo) {
  fill();
  test::writeText(path_ + "/two.block.tmp-123", "half a block");
  const WorkFolder folder(path_, 5, context_);
  EXPECT_FALSE(fs::exists(path_ + "/two.block.tmp-123"));
  EXPECT_EQ(valueOf(folder, "one"), 1.5f);
}

TEST_F(WorkFolderTest, WhatIsNoFolderIsRefused) {
  fs::create_directories(temporary_ / "a");
  test::writeText(path_, "mine");
  EXPECT_THROW(WorkFolder(path_, 5, context_), RuntimeError);
  EXPECT_THROW(WorkFolder(path_ + "/below", 5, context_), RuntimeError);
  EXPECT_EQ(test::readText(path_), "mine");
}

TEST_F(WorkFolderTest, FoldersAboveGoWithItWhereItMadeThem) {
  fill();
  WorkFolder(path_, 5, context_).remove();  // by a later run
  EXPECT_FALSE(fs::exists(temporary_ / "a"));
  EXPECT_TRUE(fs::exists(temporary_ / ""));
  EXPECT_EQ(messages_.said("1 blocks are there"), 1u) << "the note of folders is none of them";

  WorkFolder deep(temporary_ / "b/c/d/", 5, context_);
  fs::create_directories(temporary_ / "b/other");
  deep.remove();
  EXPECT_FALSE(fs::exists(temporary_ / "b/c"));
  EXPECT_TRUE(fs::exists(temporary_ / "b/other"));
}

TEST_F(WorkFolderTest, IsRemovedWithItsBlocksAlone) {
  fs::create_directories(temporary_ / "a");
  fill();
  WorkFolder(path_, 5, context_).remove();
  EXPECT_FALSE(fs::exists(path_));
  EXPECT_TRUE(fs::exists(temporary_ / "a"));
  fill();
  WorkFolder folder(path_, 5, context_);
  test::writeText(path_ + "/notes.txt", "mine");  // while it was at work
  folder.remove();
  EXPECT_FALSE(fs::exists(folder.fileOf("one")));
  EXPECT_EQ(test::readText(path_ + "/notes.txt"), "mine");
}

}  // namespace
}  // namespace lobelia::transfer
