// Sorting short lists of large items by small keys.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lobelia {

// Sorts up to 2^26 items by keys of up to 38 bits; items of one key keep their order. Only keys are
// compared and moved about, each item goes to its place once. Keeps its memory for the next list.
template <class T>
class KeySort {
 public:
  template <class Key>
  void run(std::vector<T>* items, const Key& key) {
    keys_.clear();
    for (const T& item : *items) keys_.push_back(key(item) << kPlaceBits | keys_.size());
    std::sort(keys_.begin(), keys_.end());
    sorted_.clear();
    for (const uint64_t k : keys_) sorted_.push_back((*items)[k & ((1 << kPlaceBits) - 1)]);
    items->swap(sorted_);
  }

 private:
  static constexpr int kPlaceBits = 26;
  std::vector<uint64_t> keys_;
  std::vector<T> sorted_;
};

}  // namespace lobelia
