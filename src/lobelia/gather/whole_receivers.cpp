#include "lobelia/gather/whole_receivers.h"

#include <algorithm>
#include <map>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/receiver_nodes.h"

namespace lobelia::gather {
namespace {

using trees::BoundItem;

void addTiles(const trees::BoundTree& tree, uint32_t node, std::vector<uint32_t>* tiles) {
  if (tree.nodes()[node].count <= kMaxTilePoints) return tiles->push_back(node);
  addTiles(tree, tree.left(node), tiles);
  addTiles(tree, tree.right(node), tiles);
}

// One by one: which side of a receiver is lit, its strip knows.
std::vector<BoundItem> itemsOf(const Receivers& receivers, const std::vector<uint32_t>& points) {
  std::vector<BoundItem> items(points.size());
  parallelFor(points.size(), 64, [&](size_t i) {
    const Tile tile = makeTile(receivers, points[i], points[i] + 1);
    items[i] = receiverItem(receivers, points[i], tile.strips[0], 0);
    const float weight = maxComponent(sizeOf(receivers.points[points[i]].weight));
    items[i].cosine *= weight;
    for (int g = 0; g < items[i].gaussianCount; ++g) items[i].gaussians[g].amplitude *= weight;
  });
  return items;
}

void append(const Receivers& from, uint32_t point, Receivers* to) {
  ReceiverPoint copy = from.points[point];
  const auto first = from.lobes.begin() + static_cast<ptrdiff_t>(copy.firstLobe);
  copy.firstLobe = static_cast<uint32_t>(to->lobes.size());
  to->lobes.insert(to->lobes.end(), first, first + copy.lobeCount);
  to->points.push_back(copy);
}

}  // namespace

WholeReceivers plantWholeReceivers(const Receivers& receivers, float scale) {
  std::map<LobeKinds, std::vector<uint32_t>> kinds;
  for (uint32_t i = 0; i < receivers.points.size(); ++i)
    if (receivers.points[i].lobeCount > 0)
      kinds[kindsOf(receivers, receivers.points[i])].push_back(i);
  WholeReceivers out;
  for (const auto& [kind, points] : kinds) {
    WholeReceivers::Tree& tree = out.trees.emplace_back();
    tree.first = static_cast<uint32_t>(out.order.size());
    const std::vector<BoundItem> items = itemsOf(receivers, points);
    tree.tree = trees::BoundTree(
        static_cast<uint32_t>(points.size()), [&](uint32_t i) { return items[i]; },
        trees::BoundTree::Side::receivers, scale, kStrip);
    for (const uint32_t i : tree.tree.order()) {
      out.order.push_back(points[i]);
      append(receivers, points[i], &out.receivers);
      tree.glossy = tree.glossy || items[i].gaussianCount > 0;
      tree.mostWeight =
          std::max(tree.mostWeight, maxComponent(sizeOf(receivers.points[points[i]].weight)));
    }
    addTiles(tree.tree, 0, &tree.tiles);
  }
  return out;
}

void WholeBounds::bound(std::span<const NodePair> pairs, LightClass lightClass, bool glossy,
                        float* uppers) {
  bounds_.resize(pairs.size());
  boundPairs(pairs, lightClass, false, BoundForm::tight, bounds_.data());
  for (size_t i = 0; i < pairs.size(); ++i) uppers[i] = bounds_[i].upper;
  if (!glossy) return;
  boundPairs(pairs, lightClass, true, BoundForm::tight, bounds_.data());
  for (size_t i = 0; i < pairs.size(); ++i)
    uppers[i] = std::min(uppers[i] + bounds_[i].upper, kBoundInfinity);
}

}  // namespace lobelia::gather
