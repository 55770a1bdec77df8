#include "lobelia/gather/gather_tree.h"

#include <algorithm>

#include "lobelia/base/random.h"
#include "lobelia/gather/receiver_nodes.h"

namespace lobelia::gather {

GatherTree::GatherTree(const Receivers& receivers, size_t begin, size_t end, const Tile& tile,
                       float scale, uint64_t seed)
    : seed_(seed) {
  std::vector<trees::BoundItem> items;
  std::vector<uint32_t> places;
  items.reserve(end - begin);
  for (uint32_t s = 0; s < tile.strips.size(); ++s) {
    for (uint32_t lane = 0; lane < kStrip; ++lane) {
      if (!(tile.strips[s].active >> lane & 1)) continue;
      items.push_back(receiverItem(receivers, tile.strips[s].point[lane], tile.strips[s], lane));
      places.push_back(s * kStrip + lane);
      glossy_ = glossy_ || items.back().gaussianCount > 0;
    }
  }
  tree_ = trees::BoundTree(
      static_cast<uint32_t>(items.size()), [&](uint32_t i) { return items[i]; },
      trees::BoundTree::Side::receivers, scale);
  nodes_.resize(tree_.nodes().size());
  // Bottom-up: children come after their parent.
  for (uint32_t i = static_cast<uint32_t>(nodes_.size()); i-- > 0;) {
    Node& node = nodes_[i];
    if (tree_.nodes()[i].leaf()) {
      node.place = places[tree_.item(tree_.nodes()[i].first)];
      const PointStrip& strip = tile.strips[node.place / kStrip];
      const Rgb weight = receivers.points[strip.point[node.place % kStrip]].weight;
      const Rgb size = sizeOf(weight);
      node.strength = luminance(size);
      node.most = maxComponent(size);
    } else {
      node.strength = nodes_[tree_.left(i)].strength + nodes_[tree_.right(i)].strength;
      node.most = nodes_[tree_.left(i)].most + nodes_[tree_.right(i)].most;
    }
  }
}

uint32_t GatherTree::representative(uint32_t node, uint64_t light) const {
  const uint64_t key = hashCombine(seed_, light);
  while (!tree_.nodes()[node].leaf()) {
    const uint32_t left = tree_.left(node), right = tree_.right(node);
    const double a = double{nodes_[left].strength}, b = double{nodes_[right].strength};
    const double u = static_cast<double>(hashCombine(key, node) >> 11) * 0x1p-53;
    node = u * (a + b) < a || !(b > 0) ? left : right;
  }
  return node;
}

}  // namespace lobelia::gather
