#include "lobelia/transfer/slice_records.h"

namespace lobelia::transfer {

void SliceRecords::append(std::span<const SliceRecord> records) {
  while (!records.empty()) {
    if (size_ == pieces_.size() * kPiece) {
      pieces_.emplace_back();
      // The first grows with what is in it: many have few.
      if (pieces_.size() > 1) pieces_.back().reserve(kPiece);
    }
    std::vector<SliceRecord>& piece = pieces_.back();
    const auto part = records.first(std::min(kPiece - piece.size(), records.size()));
    piece.insert(piece.end(), part.begin(), part.end());
    size_ += part.size();
    records = records.subspan(part.size());
  }
}

void SliceRecords::append(const SliceRecords& other) {
  for (const std::vector<SliceRecord>& piece : other.pieces_) append(piece);
}

}  // namespace lobelia::transfer
