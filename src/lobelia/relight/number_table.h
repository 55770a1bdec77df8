// A small hash table from numbers to numbers that is emptied and filled again and again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lobelia/base/random.h"

namespace lobelia::relight {

class NumberTable {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  NumberTable() { grow(1024); }

  void clear() {
    count_ = 0;
    if (++filling_ != 0) return;
    std::fill(cells_.begin(), cells_.end(), Cell{});  // its numbers begin anew
    filling_ = 1;
  }
  // The value of a key: where there is none yet, kNone, to be set at once (not to kNone).
  uint32_t& operator[](uint64_t key) {
    if (2 * ++count_ > cells_.size()) grow(2 * cells_.size());
    Cell& cell = find(key);
    if (cell.filling == filling_)
      --count_;
    else
      cell = {key, kNone, filling_};
    return cell.value;
  }

 private:
  struct Cell {
    uint64_t key = 0;
    uint32_t value = kNone;
    uint32_t filling = 0;  // in which it was set: those of earlier ones are empty
  };
  Cell& find(uint64_t key) {
    size_t at = mixBits(key) & (cells_.size() - 1);
    while (cells_[at].filling == filling_ && cells_[at].key != key)
      at = (at + 1) & (cells_.size() - 1);
    return cells_[at];
  }
  void grow(size_t size) {
    std::vector<Cell> old(size);
    old.swap(cells_);
    for (const Cell& cell : old)
      if (cell.filling == filling_) find(cell.key) = cell;
  }
  std::vector<Cell> cells_;  // a power of two, at most half full
  size_t count_ = 0;
  uint32_t filling_ = 1;
};

}  // namespace lobelia::relight
