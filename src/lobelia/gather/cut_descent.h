// From nodes of a cut down to one light each, children by bounds at their nearest and farthest
// distances from a receiver [Yuksel19 section 4.2] (stochastic_lightcuts.h).
#pragma once

#include "lobelia/gather/receiver_nodes.h"

namespace lobelia::gather {

// Of a child's probability, by power alone: where bounds are too low there is still some.
inline constexpr double kPowerShare = 0.05;

class CutDescent {
 public:
  explicit CutDescent(const LightForest& forest) : forest_(forest) {}

  // A node of a tree, later its descendant; u in [0, 1) decides which.
  struct Walker {
    uint32_t node = 0;
    double u = 0;
    double probability = 1;
  };
  // All of one tree, side by side, until they stand on leaves.
  void run(const ReceiverNodes& receiver, uint32_t tree, NodeBounder* bounder,
           std::span<Walker> walkers);

 private:
  void step(const LightForest::Tree& tree, const ReceiverNodes& receiver,
            std::span<const NodeBound> bounds, Walker* walker) const;

  const LightForest& forest_;
  std::vector<uint32_t> nodes_;
  std::vector<Walker*> walking_;
  std::vector<NodeBound> bounds_;
};

// Probability of the first of two children.
double firstChildProbability(const LightForest::Tree& tree, uint32_t first, uint32_t second,
                             const ReceiverNodes& receiver, const NodeBound& firstBound,
                             const NodeBound& secondBound);

}  // namespace lobelia::gather
