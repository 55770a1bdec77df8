// Bounds of the light between nodes of lights and of receivers (node_bounds-inl.h), for many pairs
// at once, in the best instructions that the processor has.
#pragma once

#include <span>

#include "lobelia/gather/light_block.h"
#include "lobelia/trees/bound_node.h"

namespace lobelia::gather {

// corrected: spheres and cones as [P000] means them; tight: never above it.
enum class BoundForm : uint8_t { corrected, tight };

// Of pairs whose places may meet.
inline constexpr float kBoundInfinity = 3.0e38f;

struct NodePair {
  const trees::BoundNode* receivers;
  const trees::BoundNode* lights;
};

// Luminances of radiance (trees/bound_node.h), without visibility.
struct PairBounds {
  float value = 0;  // between the representatives
  float upper = 0, lower = 0;
};

// Is a node's light, under a clamp (GatherSettings::clamp), at most that times the sum of its
// intensities (cosine + peak)? Those of spherical lights, powers over areas, nodes do not have;
// Gaussian ones are not clamped.
inline bool clampBounds(LightClass lightClass) {
  return lightClass != LightClass::directional && lightClass != LightClass::spherical &&
         lightClass != LightClass::gaussian;
}

// Lights of one class; receivers with Gaussians (glossy) or cosine lobes. bounds: one per pair.
void boundPairs(std::span<const NodePair> pairs, LightClass lightClass, bool glossyReceivers,
                BoundForm form, PairBounds* bounds);
// The same of one pair in scalar code.
PairBounds boundPair(const NodePair& pair, LightClass lightClass, bool glossyReceivers,
                     BoundForm form);

}  // namespace lobelia::gather
