// The light of a frame: its sums up the tree, the cut, and what refines it.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/relight/fine_light.h"

namespace lobelia::relight {

struct FrameLight {
  LightSums sums;
  LightCut cut;
  std::vector<FineUnits> fine;  // by level of the fine nodes
  Mat4 toScene;                 // takes directions of the world to the light as the scene has it
};

// turned: a rotation from the scene's light to the world's.
FrameLight makeFrameLight(const DistantLight& light, const Mat4& turned,
                          const LightSamples& samples, const SampleTree& tree,
                          const DirectionLookup& lookup, const LightCutSettings& settings);

}  // namespace lobelia::relight
