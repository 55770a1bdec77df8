// A cut that is refined by upper bounds [Walter05 section 3]: what lies in it, the largest bound on
// top, and the estimate of all light. What an item is and how one is split is the strategy's.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::gather {

// A bound that no threshold lets pass but that of 0.
inline constexpr float kLeastBound = 1e-37f;

// Item: `upper` bounds its light's luminance (0: exact, never split), `value` is its light by the
// estimate, and Item::less(a, b) orders items, all different, the one to be split first as the
// largest.
template <class Item>
class BoundedCut {
 public:
  static constexpr size_t kSplits = 16;

  void clear() { heap_.clear(), cut_.clear(), fresh.clear(), parents.clear(), estimate_ = 0; }
  // Moves the items of the largest bounds to `parents`, up to kSplits while their bound is above
  // `threshold` of the estimate's size and the cut is smaller than so many; split(parent) appends
  // its two children to `fresh`. Returns whether there was any.
  template <class Split>
  bool split(double threshold, size_t cutSize, const Split& split) {
    parents.clear(), fresh.clear();
    const float most = static_cast<float>(threshold * std::abs(estimate_));
    for (size_t size = heap_.size() + cut_.size();
         !heap_.empty() && parents.size() < kSplits && size < cutSize; ++size) {
      if (heap_.front().upper <= most) break;
      std::pop_heap(heap_.begin(), heap_.end(), Item::less);
      parents.push_back(heap_.back());
      heap_.pop_back();
      estimate_ -= double{luminance(parents.back().value)};
      split(parents.back());
    }
    return !parents.empty();
  }
  // Takes the fresh items in.
  void take() {
    for (const Item& item : fresh) {
      estimate_ += double{luminance(item.value)};
      if (item.upper > 0) {
        heap_.push_back(item);
        std::push_heap(heap_.begin(), heap_.end(), Item::less);
      } else {
        cut_.push_back(item);
      }
    }
  }
  // No more is split: all is in items().
  void end() { cut_.insert(cut_.end(), heap_.begin(), heap_.end()); }
  std::span<const Item> items() const { return cut_; }

  std::vector<Item> fresh, parents;

 private:
  double estimate_ = 0;  // luminance
  std::vector<Item> heap_, cut_;
};

}  // namespace lobelia::gather
