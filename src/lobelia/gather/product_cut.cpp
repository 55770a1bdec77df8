#include "lobelia/gather/product_cut.h"

#include <algorithm>

#include "lobelia/gather/pair_traversal.h"

namespace lobelia::gather {

bool ProductPair::less(const ProductPair& a, const ProductPair& b) {
  if (a.upper != b.upper) return a.upper < b.upper;
  if (a.power != b.power) return a.power < b.power;
  if (a.tree != b.tree) return a.tree > b.tree;
  return a.lights != b.lights ? a.lights > b.lights : a.receivers > b.receivers;
}

// The roots, and all lights that no other stands for.
void ProductCut::begin() {
  cut_.clear();
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    const auto nodes = forest_.trees[t].tree.nodes();
    ProductPair pair;
    pair.tree = t;
    for (; pair.lights < (forest_.trees[t].apart ? nodes.size() : 1); ++pair.lights)
      if (!forest_.trees[t].apart || nodes[pair.lights].leaf()) cut_.fresh.push_back(pair);
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
  return cut_.split(settings_.threshold, settings_.cutSize, [&](const ProductPair& parent) {
    const bool lights = refinesLights(receivers, parent);
    const trees::BoundTree& tree = lights ? forest_.trees[parent.tree].tree : receivers.tree();
    const uint32_t node = lights ? parent.lights : parent.receivers;
    for (const uint32_t child : {tree.left(node), tree.right(node)}) {
      ProductPair& pair = cut_.fresh.emplace_back(parent);
      (lights ? pair.lights : pair.receivers) = child;
    }
  });
}

// Tree by tree.
void ProductCut::boundFresh(const GatherTree& receivers) {
  for (uint32_t t = 0; t < forest_.trees.size(); ++t) {
    const LightForest::Tree& tree = forest_.trees[t];
    nodes_.clear(), places_.clear();
    for (size_t i = 0; i < cut_.fresh.size(); ++i) {
      if (cut_.fresh[i].tree != t) continue;
      nodes_.push_back({&receivers.tree().nodes()[cut_.fresh[i].receivers],
                        &tree.tree.nodes()[cut_.fresh[i].lights]});
      places_.push_back(static_cast<uint32_t>(i));
    }
    if (nodes_.empty()) continue;
    uppers_.resize(nodes_.size());
    bounder_.bound(nodes_, tree.lightClass, receivers.glossy(), uppers_.data());
    evaluations_ += nodes_.size();
    const bool clamped = settings_.clamp > 0 && clampBounds(tree.lightClass);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      ProductPair& pair = cut_.fresh[places_[i]];
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

}  // namespace lobelia::gather
