// Merging cuts: any number of them in one traversal [P004 section 3.2].
//
// All cuts are of one complete tree and cover all leaves, so that at every leaf each has one
// current node; these lie within one another, and the merged cut's node there is the smallest of
// them. Sums, products and whatever else is made of the current values is the caller's.
//
// Deviations:
//  - nodes are coded by level (visibility_cut.h): the smallest node is that of the smallest level,
//    which the paper finds as the smallest post-order index whose range is not empty (tests show
//    that both agree);
//  - the paper's pseudocode leaves out the factor |C'| of its equation 4: it is the caller's, and
//    follows from the level;
//  - the error bound of equation 8 holds for means over the merged node; a cut knows only that of
//    its own, coarser one. The light's is therefore read at the merged node from the whole tree
//    (LightSums).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lobelia/relight/sample_tree.h"

namespace lobelia::relight {

// Where a traversal stands in a cut. Node: anything with a member `level`.
template <class Node>
class CutCursor {
 public:
  explicit CutCursor(std::span<const Node> cut = {})
      : at_(cut.data()), end_(cut.data() + cut.size()) {
    if (!done()) endLeaf_ = 1u << at_->level;
  }
  const Node& node() const { return *at_; }
  int level() const { return at_->level; }
  uint32_t endLeaf() const { return endLeaf_; }  // where the current node ends
  bool done() const { return at_ == end_; }
  void advance() {
    if (++at_ != end_) endLeaf_ += 1u << at_->level;
  }

 private:
  const Node* at_;
  const Node* end_;
  uint32_t endLeaf_ = 0;
};

// A node of a merged cut.
struct MergedNode {
  int level = 0;
  uint32_t firstLeaf = 0;
  uint32_t leafCount() const { return 1u << level; }
  size_t heapIndex(const SampleTree& tree) const {
    return tree.heapIndex(level, firstLeaf >> level);
  }
};

// Calls f(MergedNode) for every node of the merged cut, in the order of leaves, while the cursors
// stand at the cuts' nodes that it lies in. Ends with the first cut that ends. At most as many
// steps as the cuts have nodes together.
template <class Node, class F>
void mergeCuts(std::span<CutCursor<Node>> cuts, const F& f) {
  if (cuts.empty()) return;
  for (const CutCursor<Node>& cut : cuts)
    if (cut.done()) return;
  for (uint32_t leaf = 0;;) {
    int level = cuts[0].level();
    for (const CutCursor<Node>& cut : cuts.subspan(1)) level = std::min(level, cut.level());
    f(MergedNode{level, leaf});
    leaf += 1u << level;
    for (CutCursor<Node>& cut : cuts) {
      if (cut.endLeaf() != leaf) continue;
      cut.advance();
      if (cut.done()) return;
    }
  }
}

}  // namespace lobelia::relight
