#include "lobelia/gather/cut_refinement.h"

#include <algorithm>

namespace lobelia::gather {

bool CutNode::less(const CutNode& a, const CutNode& b) {
  if (a.upper != b.upper) return a.upper < b.upper;
  if (a.power != b.power) return a.power < b.power;
  return a.tree != b.tree ? a.tree > b.tree : a.node > b.node;
}

// The roots, and all lights that no other stands for.
void CutRefinement::begin(const ReceiverNodes& receiver) {
  cut_.clear();
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    const auto nodes = forest_.trees[t].tree.nodes();
    CutNode entry;
    entry.tree = t;
    for (; entry.node < (forest_.trees[t].apart ? nodes.size() : 1); ++entry.node)
      if (!forest_.trees[t].apart || nodes[entry.node].leaf()) cut_.fresh.push_back(entry);
  }
  boundFresh(receiver);
}

bool CutRefinement::split(const ReceiverNodes& receiver) {
  const bool any = cut_.split(settings_.threshold, settings_.cutSize, [&](const CutNode& parent) {
    const trees::BoundTree& tree = forest_.trees[parent.tree].tree;
    for (const uint32_t node : {tree.left(parent.node), tree.right(parent.node)}) {
      CutNode& child = cut_.fresh.emplace_back();
      child.tree = parent.tree, child.node = node;
    }
  });
  if (any) boundFresh(receiver);
  return any;
}

// Tree by tree.
void CutRefinement::boundFresh(const ReceiverNodes& receiver) {
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    nodes_.clear(), places_.clear();
    for (size_t i = 0; i < cut_.fresh.size(); ++i) {
      if (cut_.fresh[i].tree != t) continue;
      nodes_.push_back(cut_.fresh[i].node);
      places_.push_back(static_cast<uint32_t>(i));
    }
    if (nodes_.empty()) continue;
    bounds_.resize(nodes_.size());
    bounder_.bound(receiver, t, nodes_, bounds_.data());
    const LightForest::Tree& tree = forest_.trees[t];
    for (size_t i = 0; i < nodes_.size(); ++i) {
      CutNode& entry = cut_.fresh[places_[i]];
      entry.power = luminance(tree.power[entry.node]);
      entry.unshadowed = bounds_[i].value;
      entry.upper =
          tree.tree.nodes()[entry.node].leaf() ? 0 : std::max(bounds_[i].upper, kLeastBound);
    }
  }
}

}  // namespace lobelia::gather
