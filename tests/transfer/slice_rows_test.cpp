#include "lobelia/transfer/slice_rows.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "transfer/random_rows.h"

namespace lobelia::transfer {
namespace {

std::vector<uint64_t> copy(std::span<const uint64_t> bits) { return {bits.begin(), bits.end()}; }
SliceRecords copy(const SliceRecords& records) { return records; }

TEST(SliceRows, FindWhatIsStoredAndNothingElse) {
  for (const size_t columns : {1u, 63u, 64u, 65u, 642u, 2562u}) {
    const test::RandomRows rows = test::randomRows(60, columns, 0.2f, 0, columns);
    EXPECT_TRUE(test::findsAll(rows.rows, rows)) << columns;
    EXPECT_EQ(rows.rows.rowCount(), 60u);
    EXPECT_EQ(rows.rows.columnCount(), columns);
  }
}

// A full row of the most columns: numbers of records before a word reach 2^16.
TEST(SliceRows, HoldAsManyColumnsAs16BitsCount) {
  const size_t columns = 0xffff;
  test::RandomRows rows{SliceRows(columns), {}};
  std::vector<uint32_t> where;
  std::vector<SliceRecord> records;
  rows.table.emplace_back(columns);
  for (uint32_t c = 0; c < columns; ++c) {
    where.push_back(c), records.push_back({c, 7});
    rows.table.back()[c] = records.back();
  }
  rows.rows.addRow(where, records);
  EXPECT_TRUE(test::findsAll(rows.rows, rows));
  EXPECT_TRUE(
      test::findsAll(SliceRows(columns, copy(rows.rows.bits()), copy(rows.rows.records())), rows));
  EXPECT_THROW(SliceRows{columns + 1}, std::invalid_argument);
}

TEST(SliceRows, AreMadeAgainOfBitsAndRecords) {
  const test::RandomRows rows = test::randomRows(80, 642, 0.15f, 4, 1);
  const SliceRows again(642, copy(rows.rows.bits()), copy(rows.rows.records()));
  EXPECT_TRUE(test::findsAll(again, rows));
  EXPECT_EQ(again.byteCount(), rows.rows.byteCount());
}

TEST(SliceRows, AppendInOrder) {
  const test::RandomRows whole = test::randomRows(90, 162, 0.3f, 2, 2);
  SliceRows joined(162);
  for (const auto& [first, end] : {std::pair<size_t, size_t>{0, 0}, {0, 31}, {31, 32}, {32, 90}}) {
    SliceRows part(162);
    for (size_t r = first; r < end; ++r) {
      std::vector<uint32_t> where;
      std::vector<SliceRecord> records;
      for (uint32_t c = 0; c < 162; ++c)
        if (const SliceRecord* record = whole.rows.find(r, c))
          where.push_back(c), records.push_back(*record);
      part.addRow(where, records);
    }
    joined.append(part);
  }
  EXPECT_EQ(joined.rowCount(), 90u);
  EXPECT_TRUE(test::findsAll(joined, whole));
  EXPECT_THROW(joined.append(SliceRows(163)), std::invalid_argument);
}

// Nothing that is there moves, so that it is never there twice.
TEST(SliceRows, GrowWithoutBeingMoved) {
  const std::vector<SliceRecord> full(162);
  std::vector<uint32_t> columns;
  for (uint32_t c = 0; c < 162; ++c) columns.push_back(c);
  SliceRows block(162), all(162);
  for (int r = 0; r < 256; ++r) block.addRow(columns, full);
  all.reserveRows(8 * block.rowCount());
  const auto* const bits = all.bits().data();
  std::vector<const SliceRecord*> places;
  for (int b = 0; b < 8; ++b) {
    all.append(block);
    places.push_back(all.find(static_cast<size_t>(b) * 256, 0));
  }
  EXPECT_EQ(all.bits().data(), bits);
  // But for the first of the pieces, which grows.
  for (size_t b = 2; b < 8; ++b) EXPECT_EQ(all.find(b * 256, 0), places[b]) << b;
}

TEST(SliceRows, RefuseBitsThatDoNotFit) {
  const auto empty = [](size_t count) { return SliceRecords(std::vector<SliceRecord>(count)); };
  const SliceRecords two = empty(2);
  EXPECT_NO_THROW(SliceRows(65, {1, 1}, two));
  EXPECT_THROW(SliceRows(65, {1, 1, 0}, two), std::invalid_argument) << "half a row";
  EXPECT_THROW(SliceRows(65, {1, 2}, two), std::invalid_argument) << "column 65";
  EXPECT_THROW(SliceRows(65, {1, 0}, two), std::invalid_argument) << "a record too many";
  EXPECT_THROW(SliceRows(65, {3, 1}, two), std::invalid_argument) << "a record too few";
  EXPECT_THROW(SliceRows(0, {1}, empty(1)), std::invalid_argument) << "no columns";
  EXPECT_NO_THROW(SliceRows(64, {~uint64_t{0}}, empty(64)));
}

TEST(SliceRows, TakeLittleBesidesTheirRecords) {
  const test::RandomRows rows = test::randomRows(100, 642, 0.16f, 3, 5);
  // 11 words of bits, as many numbers of 16 bits, and where the row begins.
  EXPECT_EQ(rows.rows.byteCount(), 100 * (11 * 8 + 11 * 2 + 8) + 8 * rows.rows.recordCount());
}

}  // namespace
}  // namespace lobelia::transfer
