// NPY files: the format's bytes, and what a reader by its rules finds in them.
#include "lobelia/io/npy.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <fstream>

#include "io/temporary_folder.h"
#include "lobelia/base/error.h"
#include "support/npy_reader.h"

namespace lobelia {
namespace {

using test::NpyArray;

NpyArray writtenAndRead(const std::string& type, const std::vector<size_t>& shape,
                        std::span<const std::byte> values) {
  const TemporaryFolder folder;
  io::writeNpy(folder.path("a.npy"), type, shape, values);
  return test::readNpy(folder.path("a.npy"));
}

TEST(Npy, HasTheBytesOfTheFormat) {
  if (std::endian::native != std::endian::little) GTEST_SKIP() << "bytes of this order";
  const TemporaryFolder folder;
  const std::array<float, 3> values{1, -2, 0.5f};
  const size_t shape[] = {3};
  io::writeNpy(folder.path("a.npy"), "<f4", shape, std::as_bytes(std::span(values)));
  std::string expected("\x93NUMPY\x01\x00\x76\x00", 10);
  expected += "{'descr': '<f4', 'fortran_order': False, 'shape': (3,), }";
  expected.resize(127, ' ');
  expected += '\n';
  expected += std::string("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f", 12);
  std::ifstream in(folder.path("a.npy"), std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), expected);
}

TEST(Npy, IsReadBack) {
  EXPECT_EQ(io::npyType('u', 8).substr(1), "u8");
  std::vector<int32_t> values;
  for (int32_t i = -7; i < 8; ++i) values.push_back(i * 100'000);
  const auto bytes = std::as_bytes(std::span(values));
  for (const std::vector<size_t>& shape :
       std::vector<std::vector<size_t>>{{15}, {5, 3}, {1, 15}, {3, 1, 5}}) {
    const NpyArray array = writtenAndRead(io::npyType('i', 4), shape, bytes);
    EXPECT_EQ(array.type, io::npyType('i', 4));
    EXPECT_EQ(array.shape, shape);
    EXPECT_EQ(array.headerBytes % 64, 0u);
    EXPECT_EQ(array.values<int32_t>(), values);
  }
  EXPECT_EQ(writtenAndRead("<f4", {0, 3}, {}).shape, (std::vector<size_t>{0, 3}));
  EXPECT_EQ(writtenAndRead("<f4", {}, bytes.first(4)).size(), 1u) << "a number alone";
}

TEST(Npy, IsThereWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const size_t shape[] = {1};
  const float value = 1;
  EXPECT_THROW(
      io::writeNpy(folder.path("none/a.npy"), "<f4", shape, std::as_bytes(std::span(&value, 1))),
      RuntimeError);
  EXPECT_TRUE(folder.list().empty());
}

}  // namespace
}  // namespace lobelia
