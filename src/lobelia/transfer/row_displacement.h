// The paper's table of sparse rows [P002 section 6.2; Lagae08, Lefebvre06]: all rows lie in one
// array of slots, each displaced so that its records fall where others have holes: A[i][j] = H[O[i]
// + j]. Kept to measure SliceRows against it.
//
// Deviations: each slot says whose record it has, because an empty entry may find that of another
// row. A row goes to the first place that fits, as there; but places that have refused many rows
// are not tried again before rows have half as many records, so that building takes time
// proportional to slots and not to rows times slots.
#pragma once

#include <limits>

#include "lobelia/transfer/slice_rows.h"

namespace lobelia::transfer {

class RowDisplacement {
 public:
  // Throws std::invalid_argument where slots or rows cannot be numbered in 32 bits.
  explicit RowDisplacement(const SliceRows& rows);

  // Null: nothing is stored there. row < rows.rowCount(), column < rows.columnCount().
  const SliceRecord* find(size_t row, size_t column) const {
    const uint32_t slot = offset_[row] + static_cast<uint32_t>(column);
    return slot < owner_.size() && owner_[slot] == row ? &records_[slot] : nullptr;
  }

  size_t slots() const { return records_.size(); }
  size_t recordCount() const { return recordCount_; }
  double density() const;  // records by slots; 1 where there are none
  size_t byteCount() const;

 private:
  static constexpr uint32_t kNobody = std::numeric_limits<uint32_t>::max();
  size_t recordCount_ = 0;
  std::vector<uint32_t> offset_;      // by row, modulo 2^32: a row may begin before the first slot
  std::vector<uint32_t> owner_;       // by slot: its row, or kNobody
  std::vector<SliceRecord> records_;  // by slot
};

}  // namespace lobelia::transfer
