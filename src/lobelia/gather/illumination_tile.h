// The receivers of one tile in IlluminationCut (illumination_cut.h): its coarse light, and its cut
// with the lights, traced and shaded.
#pragma once

#include "lobelia/gather/chosen_gather.h"
#include "lobelia/gather/pair_traversal.h"
#include "lobelia/gather/representatives.h"
#include "lobelia/gather/sampled_visibility.h"
#include "lobelia/gather/tile_parts.h"
#include "lobelia/gather/whole_receivers.h"

namespace lobelia::gather {

// What all tiles share.
struct IlluminationScene {
  const Tracer& tracer;
  const VirtualLights& lights;
  const PreparedLights& prepared;  // prepareLights()
  const LightForest& forest;
  const Representatives& representatives;
  const Receivers& receivers;  // WholeReceivers::receivers
  const GatherSettings& settings;
  bool sampled = true;  // visibility by few rays where they agree
  uint64_t seed = 0;
};

class IlluminationTile {
 public:
  // node: of tree.tiles. parts: of the receivers in the trees' order; null: none.
  IlluminationTile(const IlluminationScene& scene, const WholeReceivers::Tree& tree, uint32_t node,
                   GatherParts* parts, GatherTally* tally, const Context& context);

  // Adds the luminance of the coarse light to light[i] of receiver i of the trees' order, and the
  // rays that left from it.
  void estimate(std::span<double> light, std::span<uint32_t> rays);
  // Sets radiance[i] to the light of receiver i, its weight included. thresholds: of the same
  // receivers. When cancelled it is of no use.
  void gather(std::span<const float> thresholds, std::span<Rgb> radiance);

 private:
  struct Accepted : TreePair {
    bool strong = false;  // is its bound above the threshold?
  };
  // A block's nodes of lights, with their pairs.
  struct Block {
    std::span<const Accepted> pairs;
    std::vector<uint32_t> nodes;
  };
  const trees::BoundNode& node(uint32_t i) const { return tree_.tree.nodes()[i]; }
  size_t placeOf(const trees::BoundNode& node) const { return tree_.first + node.first; }
  uint32_t inTile(const trees::BoundNode& node) const {
    return node.first - this->node(node_).first;
  }
  std::vector<float> leastOf(std::span<const float> thresholds) const;
  bool goodForEstimate(const TreePair& pair, const LightForest::Tree& lights) const;
  bool refinesLights(const TreePair& pair, const LightForest::Tree& lights) const;
  void refine(const TreePair& pair, const LightForest::Tree& lights);
  void bound(const LightForest::Tree& lights);
  template <class Judge, class Accept>
  void traverse(uint32_t t, const Judge& judge, const Accept& accept);
  template <class F>
  void forBlocks(uint32_t t, std::vector<Accepted>* pairs, const F& f);
  void addEstimate(const Block& block, std::span<double> nodes, std::span<uint32_t> rays);
  void shadeBlock(const Block& block, TileParts* parts);
  void write(std::span<Rgb> radiance);

  const IlluminationScene& scene_;
  const WholeReceivers::Tree& tree_;
  const uint32_t node_;
  GatherParts* const parts_;
  GatherTally& tally_;
  const Context& context_;
  const Tile tile_;
  TileSums sums_;
  WholeBounds bounder_;
  SampledVisibility visibility_;
  LightBlock block_;
  PairMasks pairs_, allowed_;
  PairValues values_;
  std::vector<TreePair> active_, batch_;
  std::vector<Accepted> accepted_;
  std::vector<NodePair> bounded_;
  std::vector<float> uppers_;
  std::vector<LitNode> lit_;
};

}  // namespace lobelia::gather
