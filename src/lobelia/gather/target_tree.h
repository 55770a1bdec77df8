// A tree of the representatives that lights look for (dominant_lights.h): 16 to a node.
#pragma once

#include <vector>

#include "lobelia/gather/dominant_lights.h"

namespace lobelia::gather {

// Bounds of 16 targets or strips of the level below.
struct BoundStrip {
  StripV3 centre;
  alignas(64) float radius[kStrip];
  // The least radiant intensity over squared distance that may count; infinity: nothing does.
  alignas(64) float least[kStrip];
};

struct TargetTree {
  // It keeps a reference to the clusters.
  explicit TargetTree(const std::vector<ClusterTarget>& all);

  const std::vector<ClusterTarget>& clusters;
  std::vector<uint32_t> targets;                // the clusters that they stand for
  std::vector<CutReceivers> strips;             // 16 targets each
  std::vector<std::vector<BoundStrip>> levels;  // [0]: of the strips; the last: a single one
};

// A light that counts at a cluster.
struct Reached {
  uint32_t cluster, node;
  auto operator<=>(const Reached&) const = default;
};

}  // namespace lobelia::gather
