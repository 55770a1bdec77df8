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
//    found without parent links.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

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
  // A bounding sphere, whose radius is half the box's diagonal, and a cone; fixed point numbers are
  // in units of 1 / 32767.
  struct Node {
    Vec3f centre;
    float radius2;
    int16_t axis[3], cosThetaO, sinThetaO, cosThetaE;
    float intensity;
    uint32_t next;  // inner: index of the left child, which the right one follows; leaf: light
  };
  static_assert(sizeof(Node) == 36);
  struct Builder;

  static float importance(const Node& node, Vec3f p, Vec3f n);
  void prefetchBelow(size_t children) const;
  static constexpr uint64_t kAbsent = ~0ull;

  std::vector<Node> nodes_;      // the root first, siblings side by side
  std::vector<uint64_t> paths_;  // per light: below a leading one, a bit per level (1: right)
};

}  // namespace lobelia
