#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "lobelia/base/error.h"
#include "lobelia/base/file.h"
#include "lobelia/base/random.h"
#include "lobelia/store/store.h"

namespace lobelia::store {
namespace {

namespace fs = std::filesystem;

struct Item {
  float position[3];
  uint32_t id;
};

constexpr size_t kHeaderSize = 48;
constexpr size_t kItemCount = 500;

class StoreTest : public testing::Test {
 protected:
  void SetUp() override {
    file_ = (fs::temp_directory_path() /
             ("lobelia-store-" + std::to_string(::getpid()) + "-" +
              testing::UnitTest::GetInstance()->current_test_info()->name()))
                .string();
    Rng rng(1);
    for (uint32_t i = 0; i < kItemCount; ++i) {
      items_.push_back({{rng.next1D(), rng.next1D(), rng.next1D()}, i});
    }
    Writer writer("lights", 3, 0x1234567890abcdefull);
    writer.add<Item>("items", items_);
    writer.add<float>("empty", {});
    const std::vector<double> constant(100000, 1.5);
    writer.add<double>("constant", constant);
    writer.save(file_);
    good_ = readFile(file_);
  }
  void TearDown() override { fs::remove(file_); }

  // Reads everything that the file should have.
  void readAll() const {
    const Reader reader(file_, "lights", 3);
    (void)reader.get<Item>("items");
    (void)reader.get<float>("empty");
    (void)reader.get<double>("constant");
  }
  void write(std::span<const std::byte> bytes) const {
    std::ofstream out(file_, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }
  // Makes the checksum right again, as somebody with bad intentions would.
  void writeSigned(std::vector<std::byte> bytes) const {
    const uint64_t chunkBytes = bytes.size() - kHeaderSize - 8;
    std::memcpy(bytes.data() + kHeaderSize - 8, &chunkBytes, 8);
    const uint64_t checksum = hashBytes(std::span(bytes).first(bytes.size() - 8));
    std::memcpy(bytes.data() + bytes.size() - 8, &checksum, 8);
    write(bytes);
  }
  std::string errorOf(std::string_view kind, uint32_t version) const {
    try {
      const Reader reader(file_, kind, version);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  std::string file_;
  std::vector<Item> items_;
  std::vector<std::byte> good_;
};

TEST_F(StoreTest, RoundTrip) {
  const Reader reader(file_, "lights", 3);
  EXPECT_EQ(reader.sceneHash(), 0x1234567890abcdefull);
  const auto items = reader.get<Item>("items");
  ASSERT_EQ(items.size(), items_.size());
  EXPECT_EQ(std::memcmp(items.data(), items_.data(), items.size() * sizeof(Item)), 0);
  EXPECT_TRUE(reader.has("empty"));
  EXPECT_FALSE(reader.has("other"));
  EXPECT_TRUE(reader.get<float>("empty").empty());
  EXPECT_EQ(reader.get<double>("constant"), std::vector<double>(100000, 1.5));
  EXPECT_LT(good_.size(), 20000u);  // packed: the chunks hold 808 kB
}

TEST_F(StoreTest, SameDataSameBytes) {
  Writer writer("lights", 3, 0x1234567890abcdefull);
  writer.add<Item>("items", items_);
  writer.add<float>("empty", {});
  writer.add<double>("constant", std::vector<double>(100000, 1.5));
  writer.save(file_);
  EXPECT_EQ(readFile(file_), good_);
}

// Three megabytes and a bit, by pieces of one; none at all; and what is added at once, in between.
TEST_F(StoreTest, ChunksThatComeLaterAreReadAlike) {
  const auto numberAt = [](uint64_t i) { return static_cast<uint32_t>(i * i % 70001); };
  constexpr uint64_t kCount = 800001;
  uint64_t asked = 0, most = 0;
  Writer writer("lights", 3, 7);
  writer.add<Item>("items", items_);
  writer.addLater<uint32_t>("numbers", kCount, [&](uint64_t first, std::span<uint32_t> out) {
    asked += out.size(), most = std::max<uint64_t>(most, out.size());
    for (uint32_t& v : out) v = numberAt(first++);
  });
  writer.addLater<float>("empty", 0, [](uint64_t, std::span<float>) { FAIL(); });
  writer.add<Item>("again", items_);
  writer.save(file_);
  EXPECT_EQ(asked, 2 * kCount);
  EXPECT_LE(most, kCount / 3);
  const Reader reader(file_, "lights", 3);
  const auto numbers = reader.get<uint32_t>("numbers");
  ASSERT_EQ(numbers.size(), kCount);
  for (uint64_t i = 0; i < kCount; ++i) ASSERT_EQ(numbers[i], numberAt(i)) << i;
  EXPECT_TRUE(reader.get<float>("empty").empty());
  for (const char* chunk : {"items", "again"}) {
    const auto items = reader.get<Item>(chunk);
    ASSERT_EQ(items.size(), items_.size());
    EXPECT_EQ(std::memcmp(items.data(), items_.data(), items.size() * sizeof(Item)), 0) << chunk;
  }
  EXPECT_EQ(sceneHashOf(file_), 7u);
  write(std::span(good_).first(kHeaderSize - 1));
  EXPECT_THROW((void)sceneHashOf(file_), InputError);
}

TEST_F(StoreTest, WrongKindVersionChunkOrSizeIsExplained) {
  EXPECT_EQ(errorOf("visibility", 3), file_ + ": holds 'lights'; a file of 'visibility' is needed");
  EXPECT_EQ(errorOf("lights", 4),
            file_ + ": has version 3 of 'lights'; this program reads version 4");
  const Reader reader(file_, "lights", 3);
  EXPECT_THROW(reader.get<float>("items"), InputError);
  try {
    (void)reader.get<Item>("itmes");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()), file_ + ": has no chunk 'itmes'; did you mean 'items'?");
  }
}

TEST_F(StoreTest, ForeignFilesAreRefused) {
  EXPECT_THROW(Reader("/nonexistent/file", "lights", 3), InputError);
  for (const std::string text : {"", "x", "LOBELIB....", "<scene version=\"3.0.0\"/>"}) {
    write(std::as_bytes(std::span(text)));
    const char* expected = text.empty() ? "the file is empty" : "is not a Lobelia data file";
    EXPECT_NE(errorOf("lights", 3).find(expected), std::string::npos) << text;
  }
}

TEST_F(StoreTest, EveryTruncationIsRefused) {
  for (size_t n = 0; n < good_.size(); n += n < 256 ? 1 : 37) {
    write(std::span(good_).first(n));
    EXPECT_THROW(readAll(), InputError) << n << " bytes";
  }
  std::vector<std::byte> longer = good_;
  longer.push_back(std::byte{0});
  write(longer);
  EXPECT_THROW(readAll(), InputError);
}

TEST_F(StoreTest, EveryFlippedBitIsRefused) {
  for (size_t i = 0; i < good_.size(); i += i < 256 || i + 64 > good_.size() ? 1 : 29) {
    std::vector<std::byte> bad = good_;
    bad[i] ^= static_cast<std::byte>(1u << (i % 8));
    // The scene's hash is for the caller to compare, but the checksum covers it too.
    write(bad);
    EXPECT_THROW(readAll(), InputError) << "byte " << i;
  }
}

// Files with a right checksum and wrong content: refused or read, but no crash and no memory for
// sizes that nothing stands behind.
TEST_F(StoreTest, SignedGarbageIsRefusedOrRead) {
  Rng rng(5);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> bad = good_;
    // Mostly near the chunk headers: the first one and, from the end, the last.
    const size_t span = round % 3 == 0 ? bad.size() - kHeaderSize - 8 : 40;
    const size_t begin = round % 3 == 2 ? bad.size() - 8 - span - 100 : kHeaderSize;
    for (int k = 0; k < 1 + round % 4; ++k) {
      bad[begin + rng.nextUint() % span] = static_cast<std::byte>(rng.nextUint());
    }
    writeSigned(bad);
    try {
      readAll();
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 2000);
}

TEST_F(StoreTest, AbsurdSizesAreRefused) {
  struct Change {
    size_t offset, bytes;
    uint64_t value;
  };
  // Offsets in the first chunk's header: name length, item size, bytes unpacked, bytes packed.
  const Change changes[] = {{0, 4, 0xffffffff},
                            {4, 4, 0},
                            {4, 4, 7},
                            {8, 8, uint64_t{1} << 60},
                            {8, 8, kItemCount * sizeof(Item) * 2},
                            {8, 8, kItemCount * sizeof(Item) / 2},
                            {8, 8, 0},
                            {16, 8, ~uint64_t{0}},
                            {16, 8, 1}};
  for (const Change& c : changes) {
    std::vector<std::byte> bad = good_;
    std::memcpy(bad.data() + kHeaderSize + c.offset, &c.value, c.bytes);
    writeSigned(bad);
    EXPECT_THROW(readAll(), InputError) << c.offset << " " << c.value;
  }
  std::vector<std::byte> bad = good_;  // the header's own count
  const uint64_t absurd = ~uint64_t{0} - 3;
  std::memcpy(bad.data() + kHeaderSize - 8, &absurd, 8);
  write(bad);
  EXPECT_THROW(readAll(), InputError);
}

TEST(Hash, DependsOnBytesAndSeed) {
  const std::array<std::byte, 3> a{std::byte{1}, std::byte{2}, std::byte{3}};
  std::array<std::byte, 3> b = a;
  EXPECT_EQ(hashBytes(a), hashBytes(b));
  EXPECT_NE(hashBytes(a), hashBytes(a, 1));
  b[2] = std::byte{4};
  EXPECT_NE(hashBytes(a), hashBytes(b));
}

}  // namespace
}  // namespace lobelia::store
