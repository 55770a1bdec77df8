// Multidimensional lightcuts [Walter06]: a gather strategy for many lights. All receivers of a
// pixel, those of its samples and those along specular paths, are a gather tree (gather_tree.h),
// and one cut through the pairs of its nodes with those of the light trees stands for all pairs of
// a light and a receiver (product_cut.h): refined until the upper bound of each pair is below a
// share of the pixel's light. One light and one receiver stand for a pair, with a shadow ray; of a
// pair's children one shares both, so that splitting costs one light, one receiver and one ray.
//
// It needs the receivers of a pixel together: those of one call. What a pair has is given to the
// receiver that stands for it.
//
// Deviations: those of product_cut.h, gather_tree.h and receiver_nodes.h; light and receiver that
// stand for a pair keep their colours and are scaled by luminance; the light's representatives are
// the same for all pixels, the receivers' are a pixel's own. The paper draws several
// representatives of a light node, for times of motion: there is no motion here. Receivers past 256
// of a pixel have trees and cuts of their own.
#pragma once

#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/product_cut.h"
#include "lobelia/gather/representatives.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

struct MultidimensionalSettings {
  GatherSettings gather;
  double threshold = 0.02;  // ProductSettings
  size_t cutSize = 8000;
  uint64_t seed = 0;
};

// It keeps references to lights and tracer.
class MultidimensionalLightcuts : public PreparedGather {
 public:
  // Books seconds to "trees".
  MultidimensionalLightcuts(const Tracer& tracer, const VirtualLights& lights,
                            const MultidimensionalSettings& settings, Context& context);

  // Also counts "node_pairs_visited" (pairs of nodes whose bound was computed), "cut_lights" and
  // "receiver_clusters" (pairs of the cuts), "clustered_lights" and "clustered_receivers" (their
  // lights, their receivers). Books gather trees to "traverse". Groups and types cost the rays of
  // the cut once more, which count, too.
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts) const override;

 private:
  class PixelGather;

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const MultidimensionalSettings settings_;
  PreparedLights prepared_;
  LightForest forest_;
  Representatives representatives_;
};

}  // namespace lobelia::gather
