#include "lobelia/gather/product_cut.h"

#include <algorithm>
#include <cmath>

#include "lobelia/gather/pair_traversal.h"

namespace lobelia::gather {
namespace {

bool less(const ProductPair& a, const ProductPair& b) {
  if (a.upper != b.upper) return a.upper < b.upper;
  if (a.power != b.power) return a.power < b.power;
  if (a.tree != b.tree) return a.tree > b.tree;
  return a.lights != b.lights ? a.lights > b.lights : a.receivers > b.receivers;
}

// A bound that no threshold lets pass but that of 0.
constexpr float kLeastBound = 1e-37f;

}  // namespace

// The roots, and all lights that no other stands for.
void ProductCut::begin() {
  heap_.clear(), cut_.clear(), fresh_.clear(), parents_.clear();
  estimate_ = 0;
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    const auto nodes = forest_.trees[t].tree.nodes();
    ProductPair pair;
    pair.tree = t;
    for (; pair.lights < (forest_.trees[t].apart ? nodes.size() : 1); ++pair.lights)
      if (!forest_.trees[t].apart || nodes[pair.lights].leaf()) fresh_.push_back(pair);
  }
}

bool ProductCut::refinesLights(const GatherTree& receivers, const ProductPair& pair) const {
  const LightForest::Tree& tree = forest_.trees[pair.tree];
  const trees::BoundNode& p = receivers.tree().nodes()[pair.receivers];
  const trees::BoundNode& q = tree.tree.nodes()[pair.lights];
  if (p.leaf() || q.leaf()) return p.leaf();
  return lightsExtendFurther(p, p.energy > 0, q, tree.lightClass);
}

bool ProductCut::split(const GatherTree& receivers) {
  parents_.clear(), fresh_.clear();
  const float most = static_cast<float>(settings_.threshold * std::abs(estimate_));
  size_t size = heap_.size() + cut_.size();
  while (!heap_.empty() && parents_.size() < kSplits && size < settings_.cutSize) {
    if (heap_.front().upper <= most) break;
    std::pop_heap(heap_.begin(), heap_.end(), less);
    parents_.push_back(heap_.back());
    heap_.pop_back();
    const ProductPair& parent = parents_.back();
    estimate_ -= double{luminance(parent.value)};
    const bool lights = refinesLights(receivers, parent);
    const trees::BoundTree& tree = lights ? forest_.trees[parent.tree].tree : receivers.tree();
    const uint32_t node = lights ? parent.lights : parent.receivers;
    for (const uint32_t child : {tree.left(node), tree.right(node)}) {
      ProductPair& pair = fresh_.emplace_back(parent);
      (lights ? pair.lights : pair.receivers) = child;
    }
    ++size;
  }
  return !parents_.empty();
}

// Tree by tree.
void ProductCut::boundFresh(const GatherTree& receivers) {
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    const LightForest::Tree& tree = forest_.trees[t];
    nodes_.clear(), places_.clear();
    for (size_t i = 0; i < fresh_.size(); ++i) {
      if (fresh_[i].tree != t) continue;
      nodes_.push_back(
          {&receivers.tree().nodes()[fresh_[i].receivers], &tree.tree.nodes()[fresh_[i].lights]});
      places_.push_back(static_cast<uint32_t>(i));
    }
    if (nodes_.empty()) continue;
    uppers_.resize(nodes_.size());
    bounder_.bound(nodes_, tree.lightClass, receivers.glossy(), uppers_.data());
    evaluations_ += nodes_.size();
    const bool clamped = settings_.clamp > 0 && clampBounds(tree.lightClass);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      ProductPair& pair = fresh_[places_[i]];
      const trees::BoundNode& p = *nodes_[i].receivers;
      const trees::BoundNode& q = *nodes_[i].lights;
      pair.power = luminance(tree.power[pair.lights]) * receivers.strength(pair.receivers);
      float upper = uppers_[i];
      // Of glossy lights, whose cosine lobe is 0, the sum of intensities.
      if (clamped) upper = std::min(upper, settings_.clamp * (q.cosine + q.peak));
      if (tree.apart) upper = kBoundInfinity;
      upper = std::min(upper * receivers.mostStrength(pair.receivers), kBoundInfinity);
      pair.upper = p.leaf() && q.leaf() ? 0 : std::max(upper, kLeastBound);
    }
  }
}

void ProductCut::take(const GatherTree& receivers) {
  boundFresh(receivers);
  for (const ProductPair& pair : fresh_) {
    estimate_ += double{luminance(pair.value)};
    if (pair.upper > 0) {
      heap_.push_back(pair);
      std::push_heap(heap_.begin(), heap_.end(), less);
    } else {
      cut_.push_back(pair);
    }
  }
}

}  // namespace lobelia::gather
