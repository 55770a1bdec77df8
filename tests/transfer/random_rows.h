// Rows of slices as tests need them, and the same as a plain table that says what each entry has.
#pragma once

#include <optional>

#include "lobelia/base/random.h"
#include "lobelia/transfer/slice_rows.h"

namespace lobelia::test {

struct RandomRows {
  transfer::SliceRows rows;
  std::vector<std::vector<std::optional<transfer::SliceRecord>>> table;  // row, column
};

// share: of entries that are stored. runs: 0: each by itself; else about so many runs in a row.
// Every 7th row is empty, every 11th full. Records differ from one another.
inline RandomRows randomRows(size_t rowCount, size_t columns, float share, int runs,
                             uint64_t seed) {
  RandomRows out{transfer::SliceRows(columns), {}};
  Rng rng(seed);
  uint32_t number = 0;
  for (size_t r = 0; r < rowCount; ++r) {
    std::vector<bool> stored(columns, r % 11 == 5);
    if (r % 11 != 5 && r % 7 != 3) {
      const float length = share * static_cast<float>(columns) / static_cast<float>(runs);
      for (int i = 0; i < runs; ++i) {
        const size_t first = rng.nextUint() % columns;
        const auto end = first + static_cast<size_t>(length * 2 * rng.next1D());
        for (size_t c = first; c < std::min(end, columns); ++c) stored[c] = true;
      }
      for (size_t c = 0; c < columns && runs == 0; ++c) stored[c] = rng.next1D() < share;
    }
    std::vector<uint32_t> where;
    std::vector<transfer::SliceRecord> records;
    out.table.emplace_back(columns);
    for (uint32_t c = 0; c < columns; ++c)
      if (stored[c]) {
        where.push_back(c), records.push_back({++number, rng.nextUint()});
        out.table.back()[c] = records.back();
      }
    out.rows.addRow(where, records);
  }
  return out;
}

// Whether find() of SliceRows or RowDisplacement says what the table says, of every entry.
template <class Rows>
bool findsAll(const Rows& rows, const RandomRows& truth) {
  for (size_t r = 0; r < truth.table.size(); ++r)
    for (size_t c = 0; c < truth.table[r].size(); ++c) {
      const transfer::SliceRecord* found = rows.find(r, c);
      const auto& stored = truth.table[r][c];
      if ((found != nullptr) != stored.has_value() || (found && *found != *stored)) return false;
    }
  return true;
}

}  // namespace lobelia::test
