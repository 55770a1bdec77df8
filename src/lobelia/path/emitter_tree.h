// A tree over finite emitters that chooses one in proportion to an estimate of what it sends to a
// point, in O(log n).
//
// After Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting" (PACM CGIT 1(2)): surface area orientation heuristic (section 4.4), orientation cones
// (algorithm 1), importance of a cluster (section 5). Deviations:
//  - no adaptive splitting: one emitter per call, as next-event estimation wants it;
//  - the weight of a cluster is the sum of its emitters' intensities along their axes (luminance),
//    not their flux, so that a spot and an omni light that look alike at a point weigh alike;
//  - one emitter per leaf; each keeps the path from the root as bits, so that its probability is
//    found without parent links;
//  - the binary tree is taken three levels at a time: of the eight clusters that it is divided into
//    one is chosen in proportion to the estimates, which are computed side by side
//    (emitter_tree_kernels.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lobelia/path/emitter_tree_node.h"

namespace lobelia {

// What the tree knows of an emitter: its box; directions of emission: normals within thetaO of the
// axis, emission within a further thetaE of the normal; intensity: radiant intensity along the
// normals (luminance, >= 0).
struct TreeLight {
  Bounds3f bounds;
  Vec3f axis{0, 0, 1};
  float cosThetaO = 1;
  float cosThetaE = 0;
  float intensity = 0;
};

class EmitterTree {
 public:
  EmitterTree() = default;
  // Lights without intensity are left out (probability 0).
  explicit EmitterTree(std::span<const TreeLight> lights);

  struct Choice {
    uint32_t light;
    float probability;
  };
  // n: surface normal on the side that light is wanted from, or zero when any side counts. Empty
  // when nothing is expected to reach p: probabilities sum to at most one.
  std::optional<Choice> sample(Vec3f p, Vec3f n, double u) const;
  float probability(Vec3f p, Vec3f n, uint32_t light) const;
  // The slow twin of probability(), for tests: all of them, by visiting every node.
  std::vector<float> probabilities(Vec3f p, Vec3f n) const;

  bool empty() const { return nodes_.empty(); }
  size_t bytes() const;

 private:
  struct Builder;

  std::vector<EmitterTreeNode> nodes_;  // the root first
  std::vector<uint64_t> slots_;         // per light, as emitterTreeProbability() wants it
};

}  // namespace lobelia
