// A receiver as nodes of one item, for bounds of the light that nodes of light trees send it.
//
// Bounds need a cosine lobe and Gaussians above what the receiver scatters. [Walter05 section 4.2]
// bounds Phong and Ward lobes by their formulas; ours are of many kinds, so that the receiver's
// fitted Gaussians (samplingLobes()) are made as broad as its lobes are in their broader direction
// and scaled, with the cosine lobe, until they are above the lobes at a sample of directions: above
// them everywhere but for narrow peaks between the samples. They bound the largest component of the
// lobes' colour, so that bounds hold for lights of any colour (trees/bound_node.h).
#pragma once

#include "lobelia/gather/light_forest.h"
#include "lobelia/gather/receiver_bounds.h"
#include "lobelia/gather/tile.h"

namespace lobelia::gather {

// All lobes of receiver `point`, without its weight: their cosine lobe and Gaussians. strip: it is
// the strip's `lane`.
trees::BoundItem receiverItem(const Receivers& receivers, size_t point, const PointStrip& strip,
                              size_t lane);

struct ReceiverNodes {
  trees::BoundNode cosine, gaussians;  // without weight
  bool glossy = false;                 // has Gaussians
};
// strip: the first lane is receivers.points[point].
ReceiverNodes receiverNodes(const Receivers& receivers, size_t point, const PointStrip& strip);

class NodeBounder {
 public:
  // clamp: GatherSettings::clamp.
  NodeBounder(const LightForest& forest, float clamp) : forest_(forest), clamp_(clamp) {}

  // Of nodes of one tree over one receiver; bounds: one per node.
  void bound(const ReceiverNodes& receiver, uint32_t tree, std::span<const uint32_t> nodes,
             NodeBound* bounds);
  uint64_t evaluations() const { return evaluations_; }

 private:
  const LightForest& forest_;
  const float clamp_;
  uint64_t evaluations_ = 0;
};

}  // namespace lobelia::gather
