// Stochastic lightcuts [Yuksel19]: a gather strategy for many lights. Every receiver has a cut of
// the light trees, of a fixed size or refined until upper bounds are small (cut_refinement.h); for
// each of its nodes one light is drawn by a descent, anew at every receiver and sample, and over
// its probability stands for the node. The mean is the light of all lights.
//
// A child is chosen by the mean of two probabilities [Yuksel19 section 4.2]: by bounds at the
// children's nearest and at their farthest distances; where the receiver may lie in a child, by the
// farthest alone.
//
// Deviations: a share of the probability (cut_descent.h) goes by power alone, as bounds of
// receivers' and spherical lights' lobes are of fitted Gaussians; a threshold compares bounds with
// an estimate of all light without visibility, which costs no rays; those of cut_refinement.h.
#pragma once

#include "lobelia/gather/cut_refinement.h"
#include "lobelia/gather/prepared_gather.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

struct StochasticSettings {
  GatherSettings gather;
  size_t cutSize = 256;
  double threshold = 0;  // RefinementSettings; 0: a fixed size
  uint64_t seed = 0;
};

// It keeps references to lights and tracer.
class StochasticLightcuts : public PreparedGather {
 public:
  // Books seconds to "trees".
  StochasticLightcuts(const Tracer& tracer, const VirtualLights& lights,
                      const StochasticSettings& settings, Context& context);

  // Also counts "node_pairs_visited" (nodes whose bound was computed) and "cut_lights" (nodes of
  // the cuts).
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts) const override;

 private:
  class PointCut;

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const StochasticSettings settings_;
  PreparedLights prepared_;
  LightForest forest_;
  size_t lightCount_ = 0;
};

}  // namespace lobelia::gather
