// Binary tree with bounds over lights of one class, or over lobes of receivers of one kind, by
// places, normals, axes and sharpness.
//
// Deviation from [P000 section 4.1, eq. 12]: nodes are cut in the middle of their widest extent,
// where the paper sorts by a metric whose units do not match and whose weights it does not give.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "lobelia/trees/bound_node.h"

namespace lobelia::trees {

class BoundTree {
 public:
  enum class Side : uint8_t { lights, receivers };
  BoundTree() = default;
  // item(i): of `count` ones, called for each from several threads, twice. scale: size of the
  // scene, what distances count by against directions. strip: nodes of more items than that consist
  // of whole strips, but for the last. At most 2^31 items.
  BoundTree(uint32_t count, const std::function<BoundItem(uint32_t)>& item, Side side, float scale,
            uint32_t strip = 1);

  bool empty() const { return nodes_.empty(); }
  // In preorder, the root first.
  std::span<const BoundNode> nodes() const { return nodes_; }
  // Children of an inner node i.
  uint32_t left(uint32_t i) const { return i + 1; }
  uint32_t right(uint32_t i) const;
  // Number of the item at a place of the leaves' order.
  uint32_t item(uint32_t place) const { return order_[place]; }
  std::span<const uint32_t> order() const { return order_; }

 private:
  std::vector<BoundNode> nodes_;
  std::vector<uint32_t> order_;
  uint32_t strip_ = 1;
};

}  // namespace lobelia::trees
