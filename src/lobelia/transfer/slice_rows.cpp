#include "lobelia/transfer/slice_rows.h"

#include <bit>
#include <stdexcept>

namespace lobelia::transfer {

SliceRows::SliceRows(size_t columns) : columns_(columns) {
  if (columns > 0xffff)
    throw std::invalid_argument("rows of slices have fewer than 65,536 columns");
}

SliceRows::SliceRows(size_t columns, std::vector<uint64_t> bits, SliceRecords records)
    : SliceRows(columns) {
  const size_t words = wordsPerRow();
  if (words == 0 ? !bits.empty() : bits.size() % words != 0)
    throw std::invalid_argument("the bits of rows of slices are not whole rows");
  const uint64_t last = columns % 64 == 0 ? ~uint64_t{0} : (uint64_t{1} << columns % 64) - 1;
  uint64_t count = 0;
  before_.reserve(bits.size());
  for (size_t w = 0; w < bits.size(); ++w) {
    if (w % words == 0) starts_.push_back(count);
    if (w % words == words - 1 && (bits[w] & ~last) != 0)
      throw std::invalid_argument("a row of slices has more than its columns");
    before_.push_back(static_cast<uint16_t>(count - starts_.back()));
    count += static_cast<uint64_t>(std::popcount(bits[w]));
  }
  if (count != records.size())
    throw std::invalid_argument("the bits of rows of slices do not fit their records");
  bits_ = std::move(bits), records_ = std::move(records);
}

void SliceRows::reserveRows(size_t rows) {
  bits_.reserve(rows * wordsPerRow());
  before_.reserve(rows * wordsPerRow());
  starts_.reserve(rows);
}

void SliceRows::addRow(std::span<const uint32_t> columns, std::span<const SliceRecord> records) {
  const size_t first = bits_.size();
  bits_.resize(first + wordsPerRow(), 0);
  for (const uint32_t c : columns) bits_[first + c / 64] |= uint64_t{1} << c % 64;
  uint16_t before = 0;
  for (size_t w = first; w < bits_.size(); ++w) {
    before_.push_back(before);
    before = static_cast<uint16_t>(before + std::popcount(bits_[w]));
  }
  starts_.push_back(records_.size());
  records_.append(records);
}

void SliceRows::append(const SliceRows& other) {
  if (other.columns_ != columns_)
    throw std::invalid_argument("rows of slices differ in their columns");
  bits_.insert(bits_.end(), other.bits_.begin(), other.bits_.end());
  before_.insert(before_.end(), other.before_.begin(), other.before_.end());
  for (const uint64_t start : other.starts_) starts_.push_back(start + records_.size());
  records_.append(other.records_);
}

size_t SliceRows::byteCount() const {
  return bits_.size() * sizeof(uint64_t) + before_.size() * sizeof(uint16_t) +
         starts_.size() * sizeof(uint64_t) + records_.size() * sizeof(SliceRecord);
}

const SliceRecord* SliceRows::find(size_t row, size_t column) const {
  const size_t word = row * wordsPerRow() + column / 64;
  const uint64_t bit = uint64_t{1} << column % 64;
  if ((bits_[word] & bit) == 0) return nullptr;
  return &records_[starts_[row] + before_[word] +
                   static_cast<size_t>(std::popcount(bits_[word] & (bit - 1)))];
}

}  // namespace lobelia::transfer
