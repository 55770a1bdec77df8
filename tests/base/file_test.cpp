#include "lobelia/base/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "lobelia/base/error.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("lobelia-file-" + std::to_string(::getpid()) + "-" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  size_t fileCount() const {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }
  fs::path folder_;
};

std::vector<std::byte> bytesOf(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST_F(FileTest, WritesAndReadsBack) {
  writeFileAtomically(path("a"), bytesOf("hello"));
  EXPECT_EQ(readFile(path("a")), bytesOf("hello"));
  writeFileAtomically(path("a"), bytesOf("shorter"));
  EXPECT_EQ(readFile(path("a")), bytesOf("shorter"));
  writeFileAtomically(path("empty"), std::span<const std::byte>());
  EXPECT_TRUE(readFile(path("empty")).empty());
  const auto one = bytesOf("one"), two = bytesOf("two");
  const std::span<const std::byte> parts[] = {one, two};
  writeFileAtomically(path("parts"), parts);
  EXPECT_EQ(readFile(path("parts")), bytesOf("onetwo"));
  EXPECT_EQ(readFileStart(path("parts"), 3), bytesOf("one"));
  EXPECT_EQ(readFileStart(path("parts"), 99), bytesOf("onetwo"));
  EXPECT_EQ(fileCount(), 3u);  // no temporary file stays
}

TEST_F(FileTest, LeftOverTemporaryDoesNotMatter) {
  std::ofstream(path("a.tmp-" + std::to_string(::getpid()))) << "stale";
  writeFileAtomically(path("a"), bytesOf("new"));
  EXPECT_EQ(readFile(path("a")), bytesOf("new"));
}

TEST_F(FileTest, FollowsLinks) {
  writeFileAtomically(path("real"), bytesOf("old"));
  fs::create_symlink("real", path("link"));
  writeFileAtomically(path("link"), bytesOf("new"));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(readFile(path("real")), bytesOf("new"));
}

TEST_F(FileTest, WhatCannotBeWrittenIsKnownBefore) {
  writeFileAtomically(path("old"), bytesOf("old"));
  fs::create_directory(path("folder"));
  fs::create_symlink("new", path("link"));
  for (const char* good : {"new", "old", "link"}) EXPECT_EQ(whyNotWritable(path(good)), "") << good;
  EXPECT_EQ(whyNotWritable("/dev/null"), "");
  for (const std::string& bad : {path("folder"), path("missing/file"), path("old/file"),
                                 path(std::string(250, 'a')), std::string("/proc/a")}) {
    EXPECT_NE(whyNotWritable(bad), "") << bad;
    EXPECT_THROW(writeFileAtomically(bad, bytesOf("new")), RuntimeError) << bad;
  }
  EXPECT_EQ(readFile(path("old")), bytesOf("old"));
  EXPECT_EQ(fileCount(), 3u);
}

TEST_F(FileTest, LimitIsKept) {
  writeFileAtomically(path("a"), std::vector<std::byte>(100));
  EXPECT_EQ(readFile(path("a"), 100).size(), 100u);
  EXPECT_THROW(readFile(path("a"), 99), InputError);
  EXPECT_THROW(readFile("/dev/zero", 100000), InputError);  // no size, no end
}

void expectRuntimeError(const std::string& file, const std::vector<std::byte>& bytes,
                        const std::string& reason) {
  try {
    writeFileAtomically(file, bytes);
    ADD_FAILURE() << "no error for " << file;
  } catch (const RuntimeError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find(file), std::string::npos) << what;
    EXPECT_NE(what.find(reason), std::string::npos) << what;
  }
}

TEST_F(FileTest, FailuresNameFileAndReason) {
  expectRuntimeError(path("none/a"), bytesOf("x"), "No such file or directory");
  expectRuntimeError(folder_.string(), bytesOf("x"), "Is a directory");
  writeFileAtomically(path("plain"), bytesOf("x"));
  expectRuntimeError(path("plain/a"), bytesOf("x"), "Not a directory");
  EXPECT_EQ(fileCount(), 1u);
  try {
    readFile(path("missing"));
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()),
              path("missing") + ": cannot be opened: No such file or directory");
  }
  EXPECT_THROW(readFile(folder_.string()), InputError);
}

TEST_F(FileTest, FullDeviceIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expectRuntimeError("/dev/full", bytesOf("x"), "No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));  // not replaced by a file
}

// A disk that fills up half-way: the limit of the file size stands for it.
TEST_F(FileTest, FailureHalfWayKeepsTheOldFile) {
  writeFileAtomically(path("a"), bytesOf("old"));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit limited = before;
  limited.rlim_cur = 64 * 1024;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limited), 0);
  expectRuntimeError(path("a"), std::vector<std::byte>(1 << 20), "File too large");
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(readFile(path("a")), bytesOf("old"));
  EXPECT_EQ(fileCount(), 1u);
}

}  // namespace
}  // namespace lobelia
