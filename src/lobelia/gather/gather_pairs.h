// Bi-tree gathering by spherical-Gaussian lightcuts [P000 section 4]: pairs of nodes of light trees
// and of receiver trees are refined until the error of each is small against what its pixels have.
//
// Pairings of light and receiver classes come one after the other, in the paper's order: omni and
// directional lights, then diffuse to diffuse, diffuse to glossy, glossy to diffuse, glossy to
// glossy (and past the paper spherical lights). For each, the first six levels of its light trees
// give every receiver an estimate; a pair may err by a share (the threshold) of that or of what the
// pixel has from the pairings before, whichever is more. All pairs are traversed in batches, traced
// and shaded.
//
// Corrections and deviations: formulas in node_bounds-inl.h, trees in trees/bound_node.h and
// bound_tree.h, traversal in pair_traversal.h, visibility in pair_shading.h. Errors of omni and
// directional lights are always conservative: a few of them may be all the light there is, and one
// ray would decide for hundreds of receivers about a shadow that no other light softens. A
// threshold is never below .05 of it times the mean of the picture's pixels at hand, without which
// black ones were refined to leaves. It is the largest of a receiver's, then the smallest of a
// node's, where the paper takes both smallest first. The first estimate traces one ray per light
// node and strip of receivers.
#pragma once

#include <map>
#include <mutex>

#include "lobelia/gather/pair_shading.h"
#include "lobelia/gather/prepared_gather.h"

namespace lobelia::gather {

struct PairGatherSettings {
  GatherSettings gather;
  TraversalSettings traversal;
  Share share = Share::visibility;
  double threshold = 0.01;  // 0: all lights at all receivers
  uint64_t seed = 0;
};

// Lights with their trees. It keeps references to lights and tracer.
class LightPairs : public PreparedGather {
 public:
  // Books seconds to "trees".
  LightPairs(const Tracer& tracer, const VirtualLights& lights, const PairGatherSettings& settings,
             Context& context);

  // As gatherAll(), near it by the threshold; nothing is added when cancelled. Also counts
  // "node_pairs_visited" (bounds computed), and of the pairs of nodes that were shaded
  // "receiver_clusters" (how many), "clustered_receivers" and "cut_lights" (their receivers'
  // lobes), "clustered_lights" (lobes times lights, which is all of them); books the seconds of
  // receiver trees to "trees", of bounds to "traverse". Whatever onlyPixel is, all receivers are
  // gathered: errors are shared out over them.
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts = nullptr) const override;
  std::vector<ExportedTree> exportTrees() const override;

 private:
  class Run;
  const LightForest& forestFor(int receiverDepth) const;
  // Of a tree, among those of all forests.
  uint32_t numberOf(const LightForest::Tree* tree) const;

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const PairGatherSettings settings_;
  PreparedLights prepared_;
  // By the end of each class' range: receivers of different depths may gather different lights.
  mutable std::mutex mutex_;
  mutable std::map<std::vector<size_t>, LightForest> forests_;
  mutable std::vector<const LightForest*> planted_;  // the same, the first planted first
};

}  // namespace lobelia::gather
