// 64 places are tried at once: a place is bad where a slot of the row is taken, so that the bits of
// taken slots, shifted by each column and joined, say which are.
#include "lobelia/transfer/row_displacement.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>

namespace lobelia::transfer {
namespace {

// Rows refused by the 64 places of a word before it is left out, for rows of similar counts.
constexpr uint32_t kMostRefusals = 128;
// Columns tried after one another lie so far apart: neighbours say the same of many places.
constexpr size_t kStride = 32;
constexpr uint32_t kMostSlots = std::numeric_limits<uint32_t>::max() - 64;
constexpr const char* kTooMany = "row displacement numbers its slots and rows in 32 bits";

std::vector<uint32_t> columnsOf(const SliceRows& rows, size_t row) {
  std::vector<uint32_t> columns;
  const auto bits = rows.bits().subspan(row * rows.wordsPerRow(), rows.wordsPerRow());
  for (size_t w = 0; w < bits.size(); ++w)
    for (uint64_t left = bits[w]; left != 0; left &= left - 1)
      columns.push_back(static_cast<uint32_t>(w * 64) +
                        static_cast<uint32_t>(std::countr_zero(left)));
  return columns;
}

std::vector<uint32_t> spreadOut(const std::vector<uint32_t>& columns) {
  std::vector<uint32_t> out;
  out.reserve(columns.size());
  for (size_t first = 0; first < std::min(kStride, columns.size()); ++first)
    for (size_t i = first; i < columns.size(); i += kStride)
      out.push_back(columns[i] - columns.front());
  return out;
}

class Packing {
 public:
  // columns: a row's, ascending, at least one. Returns the slot of the first.
  uint32_t place(const std::vector<uint32_t>& columns) {
    const uint32_t span = columns.back() - columns.front() + 1;
    reopenFor(columns.size());
    const uint32_t slot = firstFit(spreadOut(columns));
    if (slot > kMostSlots - span) throw std::invalid_argument(kTooMany);
    reserve(slot + span);
    for (const uint32_t c : columns) {
      const uint32_t at = slot + (c - columns.front());
      taken_[at / 64] |= uint64_t{1} << at % 64;
    }
    end_ = std::max(end_, slot + span);
    return slot;
  }
  size_t slots() const { return end_; }

 private:
  uint32_t firstFit(const std::vector<uint32_t>& columns) {
    size_t closed = 0;
    for (size_t i = 0; i < open_.size(); ++i) {
      const uint32_t word = open_[i];
      if (refusals_[word] >= kMostRefusals) {
        ++closed;
        continue;
      }
      const uint64_t bad = badPlaces(word, columns);
      if (bad != ~uint64_t{0}) return word * 64 + static_cast<uint32_t>(std::countr_one(bad));
      ++refusals_[word];
    }
    if (4 * closed > open_.size())
      std::erase_if(open_, [&](uint32_t word) { return refusals_[word] >= kMostRefusals; });
    return end_;
  }

  uint64_t badPlaces(uint32_t word, const std::vector<uint32_t>& columns) const {
    uint64_t bad = 0;
    for (const uint32_t c : columns) {
      const size_t w = word + c / 64;
      if (w >= taken_.size()) continue;
      const uint32_t shift = c % 64;
      bad |= taken_[w] >> shift;
      if (shift != 0 && w + 1 < taken_.size()) bad |= taken_[w + 1] << (64 - shift);
      if (bad == ~uint64_t{0}) break;
    }
    return bad;
  }

  // Room for slots below `end`; its words are open.
  void reserve(uint32_t end) {
    for (size_t word = taken_.size(); word < (size_t{end} + 63) / 64; ++word) {
      taken_.push_back(0), refusals_.push_back(0);
      open_.push_back(static_cast<uint32_t>(word));
    }
  }

  // Words that have refused rows are asked again when rows have come to be half as long; full ones
  // never.
  void reopenFor(size_t count) {
    if (2 * count > countAtOpening_) return;
    countAtOpening_ = count;
    open_.clear();
    for (size_t word = 0; word < taken_.size(); ++word) {
      refusals_[word] = 0;
      if (taken_[word] != ~uint64_t{0}) open_.push_back(static_cast<uint32_t>(word));
    }
  }

  uint32_t end_ = 0;
  std::vector<uint64_t> taken_;     // a bit for each slot
  std::vector<uint32_t> refusals_;  // by word
  std::vector<uint32_t> open_;      // words, ascending
  size_t countAtOpening_ = std::numeric_limits<size_t>::max();
};

std::vector<uint32_t> byDecreasingCount(const SliceRows& rows) {
  std::vector<uint32_t> counts(rows.rowCount(), 0), order(rows.rowCount());
  for (size_t w = 0; w < rows.bits().size(); ++w)
    counts[w / rows.wordsPerRow()] += static_cast<uint32_t>(std::popcount(rows.bits()[w]));
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return counts[a] > counts[b]; });
  return order;
}

}  // namespace

RowDisplacement::RowDisplacement(const SliceRows& rows)
    : recordCount_(rows.recordCount()), offset_(rows.rowCount(), 0) {
  if (rows.rowCount() >= kNobody) throw std::invalid_argument(kTooMany);
  Packing packing;
  for (const uint32_t row : byDecreasingCount(rows)) {
    const std::vector<uint32_t> columns = columnsOf(rows, row);
    if (columns.empty()) break;
    offset_[row] = packing.place(columns) - columns.front();
  }
  owner_.assign(packing.slots(), kNobody);
  records_.resize(packing.slots());
  size_t next = 0;
  for (uint32_t row = 0; row < rows.rowCount(); ++row)
    for (const uint32_t column : columnsOf(rows, row)) {
      const uint32_t slot = offset_[row] + column;
      owner_[slot] = row, records_[slot] = rows.records()[next++];
    }
}

double RowDisplacement::density() const {
  return slots() == 0 ? 1 : static_cast<double>(recordCount_) / static_cast<double>(slots());
}

size_t RowDisplacement::byteCount() const {
  return offset_.size() * sizeof(uint32_t) + owner_.size() * sizeof(uint32_t) +
         records_.size() * sizeof(SliceRecord);
}

}  // namespace lobelia::transfer
