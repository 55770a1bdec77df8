#include "lobelia/gather/representatives.h"

#include "lobelia/base/random.h"

namespace lobelia::gather {

// Bottom-up: children come after their parent.
Representatives::Representatives(const LightForest& forest, uint64_t seed) : forest_(&forest) {
  for (size_t t = 0; t < forest.trees.size(); ++t) {
    const LightForest::Tree& tree = forest.trees[t];
    const auto nodes = tree.tree.nodes();
    std::vector<uint32_t>& chosen = leaves_.emplace_back(nodes.size());
    const uint64_t own = hashCombine(seed, t);
    for (uint32_t i = static_cast<uint32_t>(nodes.size()); i-- > 0;) {
      chosen[i] = i;
      if (nodes[i].leaf()) continue;
      const uint32_t left = tree.tree.left(i), right = tree.tree.right(i);
      const double a = double{luminance(tree.power[left])},
                   b = double{luminance(tree.power[right])};
      const double u = static_cast<double>(hashCombine(own, i) >> 11) * 0x1p-53;
      chosen[i] = chosen[u * (a + b) < a || !(b > 0) ? left : right];
    }
    lightCount_ += tree.lights.size();
  }
}

uint32_t Representatives::light(uint32_t tree, uint32_t node) const {
  const LightForest::Tree& t = forest_->trees[tree];
  return t.lights[t.tree.nodes()[leaf(tree, node)].first];
}

float Representatives::scale(uint32_t tree, uint32_t node) const {
  const uint32_t chosen = leaf(tree, node);
  const std::vector<Rgb>& power = forest_->trees[tree].power;
  const float own = luminance(power[chosen]);
  return chosen != node && own > 0 ? luminance(power[node]) / own : 1.f;
}

}  // namespace lobelia::gather
