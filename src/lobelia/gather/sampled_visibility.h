// Visibility of lights from nodes of receivers by few rays [Bus15]: where those of some receivers
// of a node agree, all are taken as lit or as dark; where they do not, its children are asked.
//
// The paper does not give numbers that we know of: up to kAskedAll receivers each trace their ray,
// of more one in kShare, but no fewer than kLeast, spread over those that face the light.
#pragma once

#include "lobelia/gather/kernels.h"
#include "lobelia/trees/bound_tree.h"

namespace lobelia::gather {

// Receivers of a node with one light of a block.
struct LitNode {
  uint32_t light = 0, node = 0;
  bool all = false;  // each of its receivers traces its ray
};

class SampledVisibility {
 public:
  static constexpr uint32_t kAskedAll = 16, kShare = 8, kLeast = 4;

  // pairs: of tile and block, within the nodes' receivers; those that face each other and are taken
  // as lit are kept. The nodes of one light share nothing. tree: of the receivers, of which the
  // tile has those from `first`, in its order. seed: which receivers are asked. Returns the number
  // of rays.
  size_t keep(const Tile& tile, const LightBlock& block, const Tracer& tracer,
              const trees::BoundTree& tree, uint32_t first, std::span<const LitNode> nodes,
              uint64_t seed, PairMasks* pairs);

 private:
  void ask(const trees::BoundTree& tree, uint32_t first, uint64_t seed, LitNode* node);
  void judge(const trees::BoundTree& tree, uint32_t first, const LitNode& node);

  PairMasks facing_, known_, lit_, taken_, rays_;
  std::vector<LitNode> asked_, next_;
};

}  // namespace lobelia::gather
