// Records one after the other, in pieces of half a megabyte: what grows without being known
// beforehand neither moves nor is ever there twice, as a vector would be while it doubles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {

class SliceRecords {
 public:
  SliceRecords() = default;
  explicit SliceRecords(std::span<const SliceRecord> records) { append(records); }

  void append(std::span<const SliceRecord> records);
  void append(const SliceRecords& other);
  size_t size() const { return size_; }
  const SliceRecord& operator[](size_t i) const { return pieces_[i >> kBits][i & (kPiece - 1)]; }

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = SliceRecord;
    using difference_type = std::ptrdiff_t;
    using pointer = const SliceRecord*;
    using reference = const SliceRecord&;
    Iterator() = default;
    Iterator(const SliceRecords& of, size_t at) : of_(&of), at_(at) {}
    reference operator*() const { return (*of_)[at_]; }
    Iterator& operator++() { return ++at_, *this; }
    Iterator operator++(int) { return Iterator(*of_, at_++); }
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    const SliceRecords* of_ = nullptr;
    size_t at_ = 0;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size_}; }

 private:
  static constexpr int kBits = 16;
  static constexpr size_t kPiece = size_t{1} << kBits;  // records
  std::vector<std::vector<SliceRecord>> pieces_;        // all but the last are full
  size_t size_ = 0;
};

}  // namespace lobelia::transfer
