// Receivers of one pixel as a tree [Walter06 section 3.1]: bounds of their lobes, how strongly they
// count, and one of them that stands for a node, that of one of its children, drawn by their
// strengths.
//
// Deviation: it is drawn anew for each light that a node is paired with. With one receiver for all
// pairs of a node their errors are alike and add up: that of a pixel of eight receivers under 2,000
// lights at a threshold of .02 is more than three times as large.
#pragma once

#include "lobelia/gather/whole_receivers.h"

namespace lobelia::gather {

class GatherTree {
 public:
  // receivers.points[begin, end), which are in the tile, at most kMaxTilePoints, at least one with
  // lobes. scale: size of the scene. seed: of the representatives.
  GatherTree(const Receivers& receivers, size_t begin, size_t end, const Tile& tile, float scale,
             uint64_t seed);

  // Of lobes without the receivers' weights.
  const trees::BoundTree& tree() const { return tree_; }
  bool glossy() const { return glossy_; }  // has any of them Gaussians?
  // Sums over a node of the receivers' weights, without sign: of luminances, of largest channels.
  float strength(uint32_t node) const { return nodes_[node].strength; }
  float mostStrength(uint32_t node) const { return nodes_[node].most; }
  // Leaf of the receiver that stands for a node, paired with a light; of a parent it is that of one
  // of its children.
  uint32_t representative(uint32_t node, uint64_t light) const;
  // What the light of a leaf that stands for a node is scaled by.
  float scale(uint32_t node, uint32_t leaf) const {
    const float own = nodes_[leaf].strength;
    return node != leaf && own > 0 ? nodes_[node].strength / own : 1.f;
  }
  // Place of a leaf's receiver in the tile: kStrip * strip + lane.
  uint32_t place(uint32_t leaf) const { return nodes_[leaf].place; }

 private:
  struct Node {
    float strength = 0, most = 0;
    uint32_t place = 0;  // of leaves
  };
  const uint64_t seed_;
  trees::BoundTree tree_;
  std::vector<Node> nodes_;
  bool glossy_ = false;
};

}  // namespace lobelia::gather
