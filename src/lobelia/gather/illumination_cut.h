// IlluminationCut [Bus15]: a gather strategy for many lights. Pairs of nodes of light trees and of
// trees over all receivers of a picture are refined until the upper bound of each is below a share
// (the threshold) of the light that its receivers have by a coarse picture made before. One light
// stands for a node's lights; every receiver of a pair is lit by it with its own lobes and place.
//
//  1. Coarse picture, the "geometric cut": pairs whose larger diameter is below half of the
//     distance between them; the light of one at one random receiver of each, with a shadow ray, is
//     that of all of its receivers.
//  2. From leaves to roots, the least light of a node's receivers.
//  3. The cut, by upper bounds. Of a pair the node with the larger radius is refined. A pair with a
//     single light is good whatever its bound, as its receivers are lit one by one; one whose bound
//     is 0 is dark.
//  4. Visibility by few rays where these agree (sampled_visibility.h), or by a ray of every
//     receiver: setting `sampled`. Where the bound of a single light is above the threshold, every
//     receiver has its ray in any case: shadows that few rays miss could be seen there.
//
// Deviations: bounds are ours (node_bounds-inl.h, receiver_nodes.h), which know glossy lights as
// well as diffuse ones, where the paper has none and [P000] adapts it by taking them as diffuse;
// they are compared by luminance, not channel by channel. Receivers whose lobes are of different
// kinds have trees of their own, and pairs start with nodes of at most 256 receivers and a root of
// lights: pairs with more receivers, which the paper would accept, are split. Light trees are top
// down and by class, not agglomerative. The receivers of a call (a band of the picture) are what
// the paper calls the picture; a pixel's light is the sum over its receivers, and counts as no
// less than .05 of the mean, without which black pixels were refined to leaves. Directional lights,
// which have no distance, are told apart by their angles, and in the coarse picture at no more than
// 16 receivers each.
#pragma once

#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/representatives.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

struct IlluminationCutSettings {
  GatherSettings gather;
  double threshold = 0.01;  // 0: all lights at all receivers
  bool sampled = true;      // visibility by few rays where they agree; not with a threshold of 0
  uint64_t seed = 0;
};

// It keeps references to lights and tracer.
class IlluminationCut : public PreparedGather {
 public:
  // Books seconds to "trees".
  IlluminationCut(const Tracer& tracer, const VirtualLights& lights,
                  const IlluminationCutSettings& settings, Context& context);

  // As gatherAll(), near it by the threshold; nothing is added when cancelled. Also counts
  // "node_pairs_visited" (bounds computed), and of the pairs of nodes that were shaded
  // "receiver_clusters" (how many), "clustered_receivers" and "cut_lights" (their receivers),
  // "clustered_lights" (receivers times lights); books the seconds of receiver trees to "trees", of
  // bounds to "traverse". Whatever onlyPixel is, all receivers are gathered: errors are shared out
  // over them.
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts) const override;

 private:
  class Run;

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const IlluminationCutSettings settings_;
  PreparedLights prepared_;
  LightForest forest_;
  Representatives representatives_;
};

}  // namespace lobelia::gather
