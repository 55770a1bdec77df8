// Lightcuts [Walter05]: a gather strategy for many lights. Every receiver has a cut of the light
// trees of its own, refined by upper bounds (cut_refinement.h), and one light stands for the lights
// of each node of it, with a shadow ray.
//
// The light that stands for a node is drawn once for all receivers: that of one of its children, by
// their powers. So a child shares it, and splitting a node costs one light and one ray.
//
// Deviations: those of cut_refinement.h and receiver_nodes.h; the light that stands for a node
// keeps its colour and is scaled by luminance, which makes it unbiased where the cut does not
// depend on it, in the place of the sum of intensities of each channel.
#pragma once

#include "lobelia/gather/cut_refinement.h"
#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/representatives.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

struct LightcutsSettings {
  GatherSettings gather;
  double threshold = 0.02;  // RefinementSettings
  size_t cutSize = 1000;
  uint64_t seed = 0;
};

// It keeps references to lights and tracer.
class Lightcuts : public PreparedGather {
 public:
  // Books seconds to "trees".
  Lightcuts(const Tracer& tracer, const VirtualLights& lights, const LightcutsSettings& settings,
            Context& context);

  // Also counts "node_pairs_visited" (nodes whose bound was computed) and "cut_lights" (nodes of
  // the cuts). Groups and types cost the rays of the cut once more, which count, too.
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts) const override;
  std::vector<ExportedTree> exportTrees() const override;

 private:
  class PointGather;

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const LightcutsSettings settings_;
  PreparedLights prepared_;
  LightForest forest_;
  Representatives representatives_;
};

}  // namespace lobelia::gather
