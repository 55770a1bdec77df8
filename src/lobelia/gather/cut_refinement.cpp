#include "lobelia/gather/cut_refinement.h"

#include <algorithm>

namespace lobelia::gather {
namespace {

bool less(const CutNode& a, const CutNode& b) {
  if (a.upper != b.upper) return a.upper < b.upper;
  if (a.power != b.power) return a.power < b.power;
  return a.tree != b.tree ? a.tree > b.tree : a.node > b.node;
}

// A bound that no threshold lets pass but that of 0.
constexpr float kLeastBound = 1e-37f;

}  // namespace

// The roots, and all lights that no other stands for.
void CutRefinement::begin(const ReceiverNodes& receiver) {
  heap_.clear(), cut_.clear(), fresh_.clear(), parents_.clear();
  estimate_ = 0;
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    const auto nodes = forest_.trees[t].tree.nodes();
    CutNode entry;
    entry.tree = t;
    for (; entry.node < (forest_.trees[t].apart ? nodes.size() : 1); ++entry.node)
      if (!forest_.trees[t].apart || nodes[entry.node].leaf()) fresh_.push_back(entry);
  }
  boundFresh(receiver);
}

bool CutRefinement::split(const ReceiverNodes& receiver) {
  parents_.clear(), fresh_.clear();
  const float most = static_cast<float>(settings_.threshold * estimate_);
  size_t size = heap_.size() + cut_.size();
  while (!heap_.empty() && parents_.size() < kSplits && size < settings_.cutSize) {
    if (heap_.front().upper <= most) break;
    std::pop_heap(heap_.begin(), heap_.end(), less);
    parents_.push_back(heap_.back());
    heap_.pop_back();
    const CutNode& parent = parents_.back();
    estimate_ -= double{luminance(parent.value)};
    const trees::BoundTree& tree = forest_.trees[parent.tree].tree;
    for (const uint32_t node : {tree.left(parent.node), tree.right(parent.node)}) {
      CutNode& child = fresh_.emplace_back();
      child.tree = parent.tree, child.node = node;
    }
    ++size;
  }
  if (parents_.empty()) return false;
  boundFresh(receiver);
  return true;
}

// Tree by tree.
void CutRefinement::boundFresh(const ReceiverNodes& receiver) {
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    nodes_.clear(), places_.clear();
    for (size_t i = 0; i < fresh_.size(); ++i) {
      if (fresh_[i].tree != t) continue;
      nodes_.push_back(fresh_[i].node);
      places_.push_back(static_cast<uint32_t>(i));
    }
    if (nodes_.empty()) continue;
    bounds_.resize(nodes_.size());
    bounder_.bound(receiver, t, nodes_, bounds_.data());
    const LightForest::Tree& tree = forest_.trees[t];
    for (size_t i = 0; i < nodes_.size(); ++i) {
      CutNode& entry = fresh_[places_[i]];
      entry.power = luminance(tree.power[entry.node]);
      entry.unshadowed = bounds_[i].value;
      entry.upper =
          tree.tree.nodes()[entry.node].leaf() ? 0 : std::max(bounds_[i].upper, kLeastBound);
    }
  }
}

void CutRefinement::take() {
  for (const CutNode& entry : fresh_) {
    estimate_ += double{luminance(entry.value)};
    if (entry.upper > 0) {
      heap_.push_back(entry);
      std::push_heap(heap_.begin(), heap_.end(), less);
    } else {
      cut_.push_back(entry);
    }
  }
}

}  // namespace lobelia::gather
