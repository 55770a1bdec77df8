// Which pairs of nodes stand for all pairs of their lights and receivers: top-down refinement of a
// light tree against a receiver tree, by bounds of the error [P000 section 4.2].
//
// Batches of the newest pairs are bounded side by side in registers; those that are good enough, or
// leaves on both sides, are given out; of the others one side is refined. Each pair of a light and
// a receiver is in exactly one pair given out.
//
// Corrections and deviations: a pair starts with a receiver node of a few hundred receivers, which
// threads share out among them, where the paper starts near the root. The side to refine is the one
// that extends further, by places and directions (ChildRule::extent); the paper's rule, refine the
// side whose children leave the smaller error (of lights the sum, of receivers the larger; the
// paper does not say), is a setting. A clamp lowers the bounds, too, where the paper has none.
// Thresholds may not be met exactly: an error of 0 is refined where the threshold is 0.
#pragma once

#include <functional>
#include <vector>

#include "lobelia/gather/light_forest.h"
#include "lobelia/gather/node_bounds.h"
#include "lobelia/gather/receiver_forest.h"

namespace lobelia::gather {

struct TraversalSettings {
  enum class ChildRule : uint8_t { extent, paper };
  // Error that a pair may have: conservative whatever the visibility within it, E_c = max(L, U);
  // approximate where all of it is seen as the representatives see each other,
  // E_a = max(L - Lo, U - L).
  enum class Error : uint8_t { approximate, conservative };
  ChildRule children = ChildRule::extent;
  Error error = Error::approximate;
  BoundForm bounds = BoundForm::tight;
};

struct TreePair {
  uint32_t receivers, lights;  // nodes
  friend bool operator==(const TreePair&, const TreePair&) = default;
};

// Does splitting the pair split its lights? The side that extends further, by places and
// directions; never a leaf. glossy: have the receivers Gaussians?
bool refinesLights(const trees::BoundTree& receivers, bool glossy, const LightForest::Tree& lights,
                   const TreePair& pair);
// Puts the pair's two children behind `out`.
void splitPair(const trees::BoundTree& receivers, const LightForest::Tree& lights,
               const TreePair& pair, bool splitsLights, std::vector<TreePair>* out);

// The clamp of lobes (GatherSettings::clamp; 0: none), by which bounds are lowered, too, where
// clampBounds().
struct ErrorClamp {
  float clamp = 0;
  std::span<const ClampedLight> receivers;  // by node
};

class PairTraversal {
 public:
  // Takes pairs that need not be refined further, some thousands at once. False: no more wanted.
  using Accept = std::function<bool(std::vector<TreePair>*)>;

  // glossy: have the receivers Gaussians?
  PairTraversal(const trees::BoundTree& receivers, bool glossy, const LightForest::Tree& lights,
                const TraversalSettings& settings, const ErrorClamp& clamp = {})
      : receivers_(receivers),
        glossy_(glossy),
        lights_(lights),
        settings_(settings),
        clamp_(clamp) {}

  // All pairs of the receivers of a node with the lights. thresholds: of the node and those below
  // it, in preorder. Returns how many pairs of nodes were bounded.
  size_t run(uint32_t receiverNode, const std::vector<float>& thresholds, const Accept& accept);

 private:
  void bound(const std::vector<TreePair>& pairs);
  void clampBounded(const std::vector<TreePair>& pairs);
  float errorOf(const PairBounds& bounds) const;
  void refine(const std::vector<TreePair>& pairs);
  void refineByPaper(const std::vector<TreePair>& pairs);
  void push(const TreePair& pair, bool lights) {
    splitPair(receivers_, lights_, pair, lights, &active_);
  }

  const trees::BoundTree& receivers_;
  const bool glossy_;
  const LightForest::Tree& lights_;
  const TraversalSettings settings_;
  const ErrorClamp clamp_;
  std::vector<TreePair> active_, batch_, kept_, children_;
  std::vector<NodePair> nodes_;
  std::vector<PairBounds> bounds_;
  size_t bounded_ = 0;
};

// Does a node of lights extend further than one of receivers, by places and by the directions in
// which it sends? glossy: have the receivers Gaussians?
bool lightsExtendFurther(const trees::BoundNode& receivers, bool glossy,
                         const trees::BoundNode& lights, LightClass lightClass);

// Nodes of a tree at a level below the root (0), and leaves above it.
std::vector<uint32_t> nodesOfLevel(const trees::BoundTree& tree, int level);

}  // namespace lobelia::gather
