// A sparse matrix of records: a row for each vertex, a column for each direction of the grid.
//
// The paper packs it by row displacement (row_displacement.h, kept for measuring), whose slots have
// holes and need tags, because an empty entry may find what belongs to another row. A bit for each
// entry and the number of bits before it is smaller, has neither, and can be written row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/transfer/slice_records.h"

namespace lobelia::transfer {

class SliceRows {
 public:
  SliceRows() = default;
  explicit SliceRows(size_t columns);
  // Throws std::invalid_argument when bits, starts and records do not fit together.
  SliceRows(size_t columns, std::vector<uint64_t> bits, SliceRecords records);
  // Room for so many, all told: append() then takes no more memory than rows need.
  void reserveRows(size_t rows);

  // The next row: ascending columns and their records.
  void addRow(std::span<const uint32_t> columns, std::span<const SliceRecord> records);
  // All rows of another with the same columns, in its order.
  void append(const SliceRows& other);

  size_t rowCount() const { return starts_.size(); }
  size_t columnCount() const { return columns_; }
  size_t recordCount() const { return records_.size(); }
  size_t byteCount() const;
  // Null: nothing is stored there.
  const SliceRecord* find(size_t row, size_t column) const;

  std::span<const uint64_t> bits() const { return bits_; }  // rowCount() x wordsPerRow()
  const SliceRecords& records() const { return records_; }  // row by row
  size_t wordsPerRow() const { return (columns_ + 63) / 64; }

 private:
  size_t columns_ = 0;
  std::vector<uint64_t> bits_;
  std::vector<uint16_t> before_;  // by word: records of the row before it
  std::vector<uint64_t> starts_;  // by row: its first record
  SliceRecords records_;
};

}  // namespace lobelia::transfer
