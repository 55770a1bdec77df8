// Bounds of the light of many nodes over one receiver (receiver_nodes.h): the receiver is unpacked
// once, and each node once for both kinds of lobes.
#pragma once

#include <span>

#include "lobelia/gather/node_bounds.h"

namespace lobelia::gather {

// Luminances of what a node's lights send over a receiver, without visibility: between the
// representatives, and the upper bound.
struct NodeBound {
  float value = 0, upper = 0;
};

// Sums over both kinds of lobes. gaussians: null where there are none. nodes: indices into `tree`,
// of lights of one class; bounds: one per node.
void boundNodes(const trees::BoundNode& cosine, const trees::BoundNode* gaussians,
                std::span<const trees::BoundNode> tree, std::span<const uint32_t> nodes,
                LightClass lightClass, NodeBound* bounds);

}  // namespace lobelia::gather
