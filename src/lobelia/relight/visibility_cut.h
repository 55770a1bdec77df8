// Cuts: piecewise constant approximations of a visibility function over the light tree
// [P004 sections 3.1, 3.2].
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lobelia::relight {

// A cut has, in the order of leaves, nodes that cover all leaves; where a node begins follows from
// the levels of those before it, so that neither index nor leftleaf is stored.
struct CutNode {
  uint8_t level = 0;
  uint8_t value =
      0;  // value / 255 = mean visibility over the leaves that matter (LeafBits::matters)
};
static_assert(sizeof(CutNode) == 2);  // the value's error is at most 1/510

// A binary function at the leaves of a tree (2^levels of them, 64 a word), and where it matters.
// What a vertex's function is where it does not matter is chosen to keep its cut small.
struct LeafBits {
  std::vector<uint64_t> visible, matters;
  std::vector<uint64_t> judged;  // where errors are counted, among what matters; empty: all of it
  explicit LeafBits(int levels = 0);
  int levels = 0;
  size_t wordCount() const { return visible.size(); }
};

// Cuts of many vertices.
class CutSet {
 public:
  CutSet() = default;
  // begin: where each vertex's nodes begin, and after them where the last's end.
  CutSet(std::vector<CutNode> nodes, std::vector<uint64_t> begin)
      : nodes_(std::move(nodes)), begin_(std::move(begin)) {}
  std::span<const CutNode> cut(size_t vertex) const {
    return {nodes_.data() + begin_[vertex], nodes_.data() + begin_[vertex + 1]};
  }
  size_t count() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  std::span<const CutNode> nodes() const { return nodes_; }  // of all, one cut after the other
  std::span<const uint64_t> begins() const { return begin_; }

 private:
  std::vector<CutNode> nodes_;
  std::vector<uint64_t> begin_;
};

// What cuts cost and what they leave.
struct CutReport {
  uint64_t nodes = 0;       // of all cuts
  uint64_t capped = 0;      // cuts that stopped at the largest size
  uint64_t samples = 0;     // leaves of all vertices that matter
  double squaredError = 0;  // over these, of cut and quantisation, against what was traced
  void add(const CutReport& other) {
    nodes += other.nodes, capped += other.capped, samples += other.samples;
    squaredError += other.squaredError;
  }
};

// Chooses cuts; keeps its memory from one vertex to the next. For one thread.
class CutSelector {
 public:
  // sigma: bound of each node's error (the root of the sum of squared differences from its mean)
  // [eq. 6]; mostNodes: largest cut, at least 1.
  CutSelector(float sigma, size_t mostNodes);
  // Appends the cut to `nodes` and what it is to `report`.
  void select(const LeafBits& bits, std::vector<CutNode>* nodes, CutReport* report);

 private:
  struct Count {
    uint32_t matters = 0, visible = 0;
  };
  struct Node {
    uint8_t level = 0;
    uint32_t place = 0;
    double error = 0;
  };
  Count count(uint32_t begin, uint32_t end) const;
  Count count(int level, uint32_t place) const;
  Node node(int level, uint32_t place) const;
  void refineAll(int level, uint32_t place);
  void refineLargest();
  Count judged(uint32_t begin, uint32_t end) const;
  const double threshold_;
  const size_t mostNodes_;
  const LeafBits* bits_ = nullptr;
  std::vector<uint32_t> mattersBefore_, visibleBefore_;  // leaves before each word
  std::vector<Node> chosen_;
};

}  // namespace lobelia::relight
