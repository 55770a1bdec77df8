#include "lobelia/trees/bound_tree.h"

#include <cmath>

#include "lobelia/trees/median_split.h"

namespace lobelia::trees {
namespace {

constexpr int kExtents = 7;
// A difference of normals or of axes of 1, or a factor e of sharpness, counts as much as this share
// of the scene's size.
constexpr float kNormalShare = 0.1f, kAxisShare = 0.05f, kSharpnessShare = 0.02f;

using Item = SplitItem<kExtents>;

Item coordinatesOf(const BoundItem& item, float inverseScale, uint32_t number) {
  Item c{};
  c.item = number;
  for (int d = 0; d < 3; ++d) c.x[d] = item.p[d] * inverseScale;
  if (item.gaussianCount == 0) {
    for (int d = 0; d < 3; ++d) c.x[3 + d] = kNormalShare * item.n[d];
    return c;
  }
  const BoundItem::Gaussian& g = item.gaussians[0];
  for (int d = 0; d < 3; ++d) c.x[3 + d] = kAxisShare * g.axis[d];
  c.x[6] = kSharpnessShare * std::log(std::max(g.sharpness, 1e-3f));
  return c;
}

}  // namespace

BoundTree::BoundTree(uint32_t count, const std::function<BoundItem(uint32_t)>& item, Side side,
                     float scale, uint32_t strip)
    : strip_(strip) {
  if (count == 0) return;
  const float inverseScale = 1 / std::max(scale, 1e-30f);
  std::vector<Item> items(count);
  parallelFor(count, 1024, [&](size_t i) {
    const uint32_t number = static_cast<uint32_t>(i);
    items[i] = coordinatesOf(item(number), inverseScale, number);
  });
  order_.resize(count);
  nodes_.resize(2 * size_t{count} - 1);
  const auto leaf = [&](uint32_t node, uint32_t place, uint32_t number) {
    order_[place] = number;
    nodes_[node] = leafOf(item(number), place);
  };
  const auto mergeTwo = side == Side::lights ? mergedLights : mergedReceivers;
  const auto merge = [&](uint32_t node, uint32_t a, uint32_t b) {
    nodes_[node] = mergeTwo(nodes_[a], nodes_[b]);
  };
  MedianSplit(&items, strip, leaf, merge).run();
}

uint32_t BoundTree::right(uint32_t i) const { return rightChild(i, nodes_[i].count, strip_); }

}  // namespace lobelia::trees
