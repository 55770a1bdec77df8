// Top-down order of items for a binary tree: every node is cut in the middle of its widest extent.
//
// The shape depends on the number of items alone: node i of count items in preorder has its first
// child at i + 1, with leftCount() items, and the other behind that one's nodes. Items are the same
// for any number of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lobelia/base/parallel.h"

namespace lobelia::trees {

struct SplitRange {
  uint32_t node, first, count;
};

// Items of the first child; in whole strips while there are more than one strip's.
inline uint32_t leftCount(uint32_t count, uint32_t strip = 1) {
  if (count <= strip) return count / 2;
  return (count / 2 + strip - 1) / strip * strip;
}
inline uint32_t rightChild(uint32_t node, uint32_t count, uint32_t strip = 1) {
  return node + 2 * leftCount(count, strip);
}

// Levels of nodes, the root's first. coordinate(item, dim): in units in which all kDims dimensions
// count alike. order: at least [first, first + count) items, permuted.
template <int kDims, class Coordinate>
class MedianSplit {
 public:
  MedianSplit(const Coordinate& coordinate, uint32_t strip, std::vector<uint32_t>* order)
      : coordinate_(coordinate), strip_(strip), order_(*order) {}

  std::vector<std::vector<SplitRange>> run(uint32_t firstNode, uint32_t first, uint32_t count) {
    std::vector<std::vector<SplitRange>> levels{{{firstNode, first, count}}};
    while (!levels.back().empty()) {
      const std::vector<SplitRange>& level = levels.back();
      parallelFor(level.size(), level.size() > 64 ? 16 : 1, [&](size_t i) { split(level[i]); });
      std::vector<SplitRange> next;
      for (const SplitRange& range : level) {
        if (range.count == 1) continue;
        const uint32_t left = leftCount(range.count, strip_);
        next.push_back({range.node + 1, range.first, left});
        next.push_back(
            {rightChild(range.node, range.count, strip_), range.first + left, range.count - left});
      }
      levels.push_back(std::move(next));
    }
    return levels;
  }

 private:
  void split(const SplitRange& range) {
    if (range.count < 2) return;
    float lo[kDims], hi[kDims];
    std::fill_n(lo, kDims, 3.4e38f);
    std::fill_n(hi, kDims, -3.4e38f);
    const auto begin = order_.begin() + range.first, end = begin + range.count;
    for (auto it = begin; it != end; ++it) {
      for (int d = 0; d < kDims; ++d) {
        const float x = coordinate_(*it, d);
        lo[d] = std::min(lo[d], x), hi[d] = std::max(hi[d], x);
      }
    }
    int widest = 0;
    for (int d = 1; d < kDims; ++d)
      if (hi[d] - lo[d] > hi[widest] - lo[widest]) widest = d;
    std::vector<std::pair<float, uint32_t>> keys;
    keys.reserve(range.count);
    for (auto it = begin; it != end; ++it) keys.emplace_back(coordinate_(*it, widest), *it);
    std::nth_element(keys.begin(), keys.begin() + leftCount(range.count, strip_), keys.end());
    for (uint32_t i = 0; i < range.count; ++i) begin[i] = keys[i].second;
  }

  const Coordinate& coordinate_;
  const uint32_t strip_;
  std::vector<uint32_t>& order_;
};

}  // namespace lobelia::trees
