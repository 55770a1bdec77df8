// Shared stochastic cuts: a gather strategy for very many lights (docs/manual.md).
//
// A cluster of up to 16 neighbouring receivers shares a cut of the light trees, chosen by estimates
// of what its nodes contribute and how much that varies within them. For every node one of its
// lights is drawn, children by their estimates [Yuksel19 section 4]; over its probability it stands
// for the node at every receiver of the cluster, each with its own reflectance. One shadow ray per
// light, from a receiver drawn among the cluster's, answers for all of them
// (CutGatherSettings::shared), but for lights that matter much alone and where some lights, whose
// rays start at every receiver, show that these do not see alike; or every receiver traces its own.
// Lights that matter much are not left to chance: they are found from their own side
// (dominant_lights.h).
//
// Past [P000], whose pairs of light and pixel nodes are refined until upper bounds allow to copy
// one representative's light to all pixels: what is drawn is unbiased for every receiver, so that
// estimates do in the place of bounds, and only visibility is shared. Past [Yuksel19]: receivers
// share the cut and the lights, drawn by importance for few representatives of theirs, and the cut
// is chosen by estimates of the standard deviation.
#pragma once

#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/tree_lights.h"

namespace lobelia::gather {

struct CutGatherSettings {
  GatherSettings gather;
  CutSettings cut;
  bool shared = true;  // visibility, in clusters of neighbouring pixels
  int width = 1;       // pixels in a row of the data window
  uint64_t seed = 0;
};

// Lights with their trees. It keeps references to lights and tracer.
class LightCuts : public PreparedGather {
 public:
  // Books seconds to "trees".
  LightCuts(const Tracer& tracer, const VirtualLights& lights, const CutGatherSettings& settings,
            Context& context);

  // As gatherAll(), whose mean this has but for visibility where it is shared. Also counts
  // "node_pairs_visited" (nodes whose estimate was computed), "cut_lights", "receiver_clusters",
  // "clustered_receivers" and "clustered_lights" (lights times clusters), "dominant_lights" and
  // "dominant_comparisons" (DominantLights), "error_missed" (clusters for which CutSettings::error
  // was too much); books the seconds of choosing lights to "traverse". onlyPixel:
  // GatherSettings::onlyPixel, for clusters.
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts = nullptr) const override;
  std::vector<ExportedTree> exportTrees() const override;

 private:
  class ClusterGather;

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const CutGatherSettings settings_;
  const LightNumbers numbers_;
  trees::LightTree trees_[kLightTrees];
  PreparedLights prepared_;
};

}  // namespace lobelia::gather
