// Binary trees over items: every node is cut in the middle of its widest extent, top-down, and made
// from its children, bottom-up.
//
// The shape depends on the number of items alone: node i of count items in preorder has its first
// child at i + 1, with leftCount() items, and the other behind that one's nodes. The tree is the
// same for any number of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lobelia/base/parallel.h"

namespace lobelia::trees {

// Items of the first child; in whole strips while there are more than one strip's.
inline uint32_t leftCount(uint32_t count, uint32_t strip = 1) {
  if (count <= strip) return count / 2;
  return (count / 2 + strip - 1) / strip * strip;
}
inline uint32_t rightChild(uint32_t node, uint32_t count, uint32_t strip = 1) {
  return node + 2 * leftCount(count, strip);
}

// An item with its coordinates, in units in which all dimensions count alike.
template <int kDims>
struct SplitItem {
  float x[kDims];
  uint32_t item;
};

// leaf(node, place, item) and merge(node, left, right) make the nodes, from several threads. The
// items are sorted into the leaves' order.
template <int kDims, class Leaf, class Merge>
class MedianSplit {
 public:
  MedianSplit(std::vector<SplitItem<kDims>>* items, uint32_t strip, const Leaf& leaf,
              const Merge& merge)
      : items_(*items), strip_(strip), leaf_(leaf), merge_(merge) {}

  // Level by level until subtrees fit a cache, which threads share out among them.
  void run() {
    std::vector<Range> above, subtrees, level{{0, 0, static_cast<uint32_t>(items_.size())}};
    while (!level.empty()) {
      std::erase_if(level, [&](const Range& range) {
        if (range.count <= kSubtree) subtrees.push_back(range);
        return range.count <= kSubtree;
      });
      parallelFor(level.size(), 1, [&](size_t i) { split(level[i]); });
      above.insert(above.end(), level.begin(), level.end());
      std::vector<Range> next;
      for (const Range& range : level) {
        next.push_back(left(range));
        next.push_back(right(range));
      }
      level = std::move(next);
    }
    parallelFor(subtrees.size(), 1, [&](size_t i) { build(subtrees[i]); });
    for (auto range = above.rbegin(); range != above.rend(); ++range)
      merge_(range->node, left(*range).node, right(*range).node);
  }

 private:
  static constexpr uint32_t kSubtree = 4096;
  struct Range {
    uint32_t node, first, count;
  };

  Range left(const Range& r) const { return {r.node + 1, r.first, leftCount(r.count, strip_)}; }
  Range right(const Range& r) const {
    const uint32_t before = leftCount(r.count, strip_);
    return {rightChild(r.node, r.count, strip_), r.first + before, r.count - before};
  }

  void build(const Range& range) {
    if (range.count == 1) return leaf_(range.node, range.first, items_[range.first].item);
    split(range);
    build(left(range));
    build(right(range));
    merge_(range.node, left(range).node, right(range).node);
  }

  void split(const Range& range) {
    float lo[kDims], hi[kDims];
    std::fill_n(lo, kDims, 3.4e38f);
    std::fill_n(hi, kDims, -3.4e38f);
    const auto begin = items_.begin() + range.first, end = begin + range.count;
    for (auto it = begin; it != end; ++it)
      for (int d = 0; d < kDims; ++d)
        lo[d] = std::min(lo[d], it->x[d]), hi[d] = std::max(hi[d], it->x[d]);
    int widest = 0;
    for (int d = 1; d < kDims; ++d)
      if (hi[d] - lo[d] > hi[widest] - lo[widest]) widest = d;
    std::nth_element(begin, begin + leftCount(range.count, strip_), end,
                     [widest](const SplitItem<kDims>& a, const SplitItem<kDims>& b) {
                       return a.x[widest] != b.x[widest] ? a.x[widest] < b.x[widest]
                                                         : a.item < b.item;
                     });
  }

  std::vector<SplitItem<kDims>>& items_;
  const uint32_t strip_;
  const Leaf& leaf_;
  const Merge& merge_;
};

}  // namespace lobelia::trees
