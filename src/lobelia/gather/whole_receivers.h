// Receivers in trees with bounds of all of their lobes together: one tree for all receivers whose
// lobes are of the same kinds, so that a strip (tile.h) of its leaves has neighbours in space and
// direction that are shaded alike.
//
// A node has both a cosine lobe and Gaussians (receiverItem()), of which its bounds are the sum:
// boundPairs() for the one and, where a tree is glossy, for the other. Only their upper bounds
// mean anything.
#pragma once

#include "lobelia/gather/node_bounds.h"
#include "lobelia/gather/tile.h"
#include "lobelia/trees/bound_tree.h"

namespace lobelia::gather {

// Of a receiver's weight, for bounds: filters have weights below 0, too.
inline Rgb sizeOf(Rgb weight) { return max(weight, Rgb(0.f) - weight); }

struct WholeReceivers {
  struct Tree {
    uint32_t first = 0;    // of its receivers, which are in the leaves' order
    bool glossy = false;   // has any of them Gaussians?
    float mostWeight = 0;  // largest channel of the receivers' weights
    // Of lobes times the largest channel of the weight: above the luminance of what they send.
    trees::BoundTree tree;
    // The largest nodes with at most kMaxTilePoints receivers; they share nothing.
    std::vector<uint32_t> tiles;
  };
  Receivers receivers;          // tree after tree; those without lobes are left out
  std::vector<uint32_t> order;  // which of those given they are
  std::vector<Tree> trees;      // none is empty
};

// scale: size of the scene. The same for any number of threads.
WholeReceivers plantWholeReceivers(const Receivers& receivers, float scale);

// Upper bounds of pairs of nodes of whole receivers and of lights of one class: luminances, without
// visibility.
class WholeBounds {
 public:
  // uppers: one per pair.
  void bound(std::span<const NodePair> pairs, LightClass lightClass, bool glossy, float* uppers);

 private:
  std::vector<PairBounds> bounds_;
};

}  // namespace lobelia::gather
