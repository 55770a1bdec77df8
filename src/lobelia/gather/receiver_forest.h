// Receivers in trees with bounds, lobe by lobe [P000 section 4.1]: materials of several lobes enter
// with each of them, and a tree holds lobes of one kind, so that a strip (tile.h) of its leaves has
// neighbours in space and direction that are shaded alike.
//
// Bounds of a lobe are those of its fitted Gaussians (samplingLobes()): they do not hold for what
// Ward and GGX lobes have beyond these at grazing view and in their tails. The envelopes of
// receiver_nodes.h do, but have a cosine lobe beside the Gaussians, where the bounds of a pair of
// nodes are of either kind, and they are broader than the lobe, so that as representatives they
// would not estimate its light.
#pragma once

#include "lobelia/gather/tile.h"
#include "lobelia/trees/bound_tree.h"

namespace lobelia::gather {

// What receivers send of a light of unit intensity where the clamp is 1 and their lobes reach it:
// weights times colours of lobes whose largest component is 1.
struct ClampedLight {
  float most = 0;   // largest component, of any receiver
  float mean = 0;   // luminance, of their mean
  float least = 0;  // least component, of any
};

struct ReceiverForest {
  struct Tree {
    bool glossy = false;           // Gaussians, not cosine lobes
    uint8_t depth = 0;             // of all its receivers, where depths are kept apart
    Receivers receivers;           // in the leaves' order, each with one lobe
    std::vector<uint32_t> points;  // which of the points given they are
    // Where wanted: the same with all of their lobes, of the same kinds for all of them; empty when
    // they have no others.
    Receivers whole;
    // Bounds of a receiver's lobe times its weight, channel by channel (BoundItem::mean).
    trees::BoundTree tree;
    std::vector<ClampedLight> clamped;  // by node, where wholes are wanted
    // The largest nodes with at most kMaxTilePoints receivers; they share nothing.
    std::vector<uint32_t> tiles;
  };
  std::vector<Tree> trees;  // none is empty
};

// scale: size of the scene. byDepth: receivers of different depths in different trees. wholes: fill
// Tree::whole and Tree::clamped? The same for any number of threads.
ReceiverForest plantReceivers(const Receivers& receivers, float scale, bool byDepth, bool wholes);

}  // namespace lobelia::gather
