#include "lobelia/io/exr_header.h"

#include <gtest/gtest.h>

#include <cstring>

#include "io/temporary_folder.h"
#include "lobelia/base/file.h"
#include "lobelia/io/image_io.h"

namespace lobelia {
namespace {

std::vector<std::byte> exrFile() {
  const TemporaryFolder folder;
  Film film;
  film.width = 3, film.height = 2;
  film.fullWidth = 3, film.fullHeight = 2;
  film.addLayer("").values.assign(18, 0.5f);
  io::writeExr(folder.path("a.exr"), film);
  return readFile(folder.path("a.exr"));
}

// Where the size of an attribute stands: behind its name and its type.
size_t sizeOf(const std::vector<std::byte>& bytes, const std::string& name,
              const std::string& type) {
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string key = name + '\0' + type + '\0';
  const size_t at = text.find(key);
  EXPECT_NE(at, text.npos) << name;
  return at + key.size();
}

void put(std::vector<std::byte>& bytes, size_t at, int32_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

TEST(ExrHeader, AcceptsWhatWeWrite) {
  const auto bytes = exrFile();
  EXPECT_EQ(io::exrHeaderProblem(bytes, bytes.size(), 1 << 16), "");
}

TEST(ExrHeader, FindsAttributesLargerThanTheFile) {
  auto bytes = exrFile();
  for (const int32_t size : {1 << 30, -1}) {
    put(bytes, sizeOf(bytes, "channels", "chlist"), size);
    EXPECT_TRUE(contains(io::exrHeaderProblem(bytes, bytes.size(), 1 << 16), "channels")) << size;
  }
}

// The library reads values by what they hold: a wrong size puts what follows in the wrong place.
TEST(ExrHeader, FindsSizesThatDoNotFitTheValue) {
  const auto good = exrFile();
  const std::pair<const char*, const char*> attributes[] = {
      {"channels", "chlist"}, {"compression", "compression"}, {"dataWindow", "box2i"}};
  for (const auto& [name, type] : attributes) {
    for (const int32_t more : {-1, 1}) {
      auto bytes = good;
      const size_t at = sizeOf(bytes, name, type);
      int32_t size = 0;
      std::memcpy(&size, bytes.data() + at, sizeof(size));
      put(bytes, at, size + more);
      const std::string problem = io::exrHeaderProblem(bytes, bytes.size(), 1 << 16);
      EXPECT_TRUE(contains(problem, name) && contains(problem, "cannot have")) << problem;
    }
  }
}

TEST(ExrHeader, FindsAbsurdWindows) {
  auto bytes = exrFile();
  const size_t window = sizeOf(bytes, "dataWindow", "box2i") + 4;
  put(bytes, window + 12, 2'000'000'000);
  EXPECT_TRUE(contains(io::exrHeaderProblem(bytes, bytes.size(), 1 << 16), "2000000001"));
  put(bytes, window + 12, -5);
  EXPECT_NE(io::exrHeaderProblem(bytes, bytes.size(), 1 << 16), "");
}

TEST(ExrHeader, FindsTruncation) {
  const auto bytes = exrFile();
  for (size_t n = 8; n < 200; n += 13)
    EXPECT_NE(io::exrHeaderProblem(std::span(bytes).first(n), n, 1 << 16), "") << n;
  // The start of a longer file is not a truncated one.
  EXPECT_EQ(io::exrHeaderProblem(std::span(bytes).first(100), bytes.size(), 1 << 16), "");
}

TEST(ExrHeader, LeavesOtherFormatsAlone) {
  const std::vector<std::byte> png(64, std::byte{0x89});
  EXPECT_EQ(io::exrHeaderProblem(png, png.size(), 1 << 16), "");
}

}  // namespace
}  // namespace lobelia
