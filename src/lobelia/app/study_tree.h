// Trees over many items of which each has a binary value, and the cost of cuts through them: what
// studies compare light trees by. Nodes may have any number of children [P004 section 3.2: cuts do
// not rely on binary trees].
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lobelia::app {

struct StudyTree {
  struct Node {
    uint32_t begin = 0, end = 0;              // its leaves
    uint32_t firstChild = 0, childCount = 0;  // children follow one another; none: a leaf
  };
  std::vector<uint32_t> order;  // leaf i is item order[i]
  std::vector<Node> nodes;      // the root first
};

// Over the texels of a cube map, (face * side + y) * side + x: below the root six faces, each cut
// into four squares again and again; or three pairs of faces, each halved again and again, along x
// and y in turn. side: a power of two.
StudyTree cubeQuadTree(uint32_t side);
StudyTree cubeBinaryTree(uint32_t side);
// Items in an order of which halves are nodes and their halves, the first being the smaller one
// (relight/median_clusters.h).
StudyTree halvedTree(std::vector<uint32_t> order);

struct CutCost {
  size_t nodes = 0;
  double squaredError = 0;  // of all leaves that matter against their node's mean
};

// Cuts of one binary function after another. For one thread.
class CutCounter {
 public:
  explicit CutCounter(const StudyTree& tree);  // keeps a reference
  // Bits of the items, 64 a word; matters: where errors count, empty: everywhere.
  void set(std::span<const uint64_t> visible, std::span<const uint64_t> matters);
  // The smallest cut whose nodes' errors are at most sigma, as CutSelector has it
  // (relight/visibility_cut.h), with means not quantised and without a limit of its size.
  CutCost cost(double sigma) const;
  // Sum of squared differences from their mean of the leaves [begin, end) that matter.
  double squaredError(uint32_t begin, uint32_t end) const;

 private:
  void add(const StudyTree::Node& node, double most, CutCost* cost) const;
  const StudyTree& tree_;
  std::vector<uint32_t> visibleBefore_, mattersBefore_;  // by leaf
};

}  // namespace lobelia::app
