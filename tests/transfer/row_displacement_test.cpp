// Rows displaced into one array, against a plain table and against first fit slot by slot.
#include "lobelia/transfer/row_displacement.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "transfer/random_rows.h"

namespace lobelia::transfer {
namespace {

// Slots that first fit needs: rows by decreasing count, every place tried.
size_t slotsOfFirstFit(const test::RandomRows& rows) {
  std::vector<std::vector<size_t>> columns;
  for (const auto& row : rows.table) {
    columns.emplace_back();
    for (size_t c = 0; c < row.size(); ++c)
      if (row[c]) columns.back().push_back(c);
  }
  std::stable_sort(columns.begin(), columns.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<bool> taken;
  for (const auto& row : columns) {
    if (row.empty()) continue;
    const auto slotOf = [&](size_t place, size_t c) { return place + c - row[0]; };
    size_t place = 0;
    while (std::ranges::any_of(
        row, [&](size_t c) { return slotOf(place, c) < taken.size() && taken[slotOf(place, c)]; }))
      ++place;
    taken.resize(std::max(taken.size(), slotOf(place, row.back()) + 1));
    for (const size_t c : row) taken[slotOf(place, c)] = true;
  }
  return taken.size();
}

TEST(RowDisplacement, FindsWhatIsStoredAndNothingElse) {
  for (const size_t columns : {1u, 42u, 64u, 162u, 642u})
    for (const int runs : {0, 1, 4}) {
      const test::RandomRows rows = test::randomRows(120, columns, 0.16f, runs, columns);
      const RowDisplacement packed(rows.rows);
      EXPECT_TRUE(test::findsAll(packed, rows)) << columns << " columns, " << runs << " runs";
      EXPECT_EQ(packed.recordCount(), rows.rows.recordCount());
      EXPECT_GE(packed.slots(), packed.recordCount());
      EXPECT_EQ(packed.byteCount(), 12 * packed.slots() + 4 * rows.rows.rowCount());
    }
}

// So few rows that no place has refused many.
TEST(RowDisplacement, IsFirstFit) {
  for (const int runs : {0, 1, 3, 12}) {
    const test::RandomRows rows = test::randomRows(100, 162, 0.15f, runs, 3);
    EXPECT_EQ(RowDisplacement(rows.rows).slots(), slotsOfFirstFit(rows)) << runs << " runs";
  }
}

// Where places are given up, some slots more are spent: up to a twentieth (runs), or a little more
// (single records).
TEST(RowDisplacement, StaysNearFirstFitForManyRows) {
  for (const int runs : {0, 3}) {
    const test::RandomRows rows = test::randomRows(2000, 42, 0.15f, runs, 9);
    const auto best = static_cast<double>(slotsOfFirstFit(rows));
    EXPECT_LE(static_cast<double>(RowDisplacement(rows.rows).slots()), 1.08 * best) << runs;
  }
}

TEST(RowDisplacement, PacksRunsDensely) {
  const test::RandomRows rows = test::randomRows(1500, 642, 0.16f, 3, 7);
  const RowDisplacement packed(rows.rows);
  EXPECT_GT(packed.density(), 0.75);
  EXPECT_LE(packed.density(), 1);
}

TEST(RowDisplacement, TakesNoRowsAndEmptyOnes) {
  SliceRows rows(642);
  const RowDisplacement none(rows);
  EXPECT_EQ(none.slots(), 0u);
  EXPECT_EQ(none.density(), 1);
  rows.addRow({}, {});
  rows.addRow({}, {});
  const RowDisplacement packed(rows);
  EXPECT_EQ(packed.slots(), 0u);
  EXPECT_EQ(packed.find(1, 641), nullptr);
}

// The first slot is taken by a record of a row's end: its offset is below 0.
TEST(RowDisplacement, ARowMayBeginBeforeTheFirstSlot) {
  SliceRows rows(642);
  const std::vector<uint32_t> column{641};
  rows.addRow(column, std::vector<SliceRecord>{{5, 6}});
  const RowDisplacement packed(rows);
  EXPECT_EQ(packed.slots(), 1u);
  ASSERT_NE(packed.find(0, 641), nullptr);
  EXPECT_EQ(*packed.find(0, 641), (SliceRecord{5, 6}));
  for (size_t c = 0; c < 641; ++c) EXPECT_EQ(packed.find(0, c), nullptr) << c;
}

}  // namespace
}  // namespace lobelia::transfer
