// What some of a scene's vertices see of any set of directions: figures 5 and 8 compare trees and
// bases by it without the cuts of all vertices.
#pragma once

#include <functional>

#include "lobelia/app/bench_cuts.h"
#include "lobelia/relight/pilot_visibility.h"
#include "lobelia/relight/vertex_visibility.h"

namespace lobelia::app {

class StudyVertices {
 public:
  // count: how many of the scene's vertices (welded, nothing subdivided) are looked at, one in each
  // of as many even clusters. Keeps references. context: of the seed, and cancels.
  StudyVertices(const Tracer& tracer, size_t count, Context& context);

  size_t count() const { return chosen_.size(); }
  size_t sceneCount() const { return order_.size(); }

  // The directions' order in a tree by the metric (1 - beta) d_v + beta d_g [P004 eq. 13], for
  // several beta with the same pilot visibility. Throws Cancelled.
  std::vector<std::vector<uint32_t>> treeOrders(const relight::LightSamples& samples,
                                                std::span<const float> betas) const;

  // One thread's work on one vertex after another; parts may go to different threads.
  using Use = std::function<void(size_t vertex, const relight::LeafBits& bits)>;
  using MakeUse = std::function<Use()>;  // called once for each part
  // What each vertex sees of the samples, all of them traced: Use gets 0 to count() - 1 and bits by
  // sample, of which `matters` are those in front of one of its faces. Throws Cancelled.
  void trace(const relight::LightSamples& samples, const MakeUse& makeUse) const;

 private:
  const Tracer& tracer_;
  Context& context_;
  const relight::SampleMesh mesh_;
  const relight::VertexFaces faces_;
  const std::vector<uint32_t> order_;  // of the scene's vertices, by clusters
  std::vector<uint32_t> chosen_;
};

}  // namespace lobelia::app
