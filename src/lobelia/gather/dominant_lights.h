// Lights that may each make much of what a cluster of receivers gets, found from the lights' side.
// A node of a light tree tells badly of a single light whose lobe is sharp or that is near: drawn
// too rarely, it flares, or lacks (gather_cuts.h). So lights look for the clusters that they reach
// strongly, down a tree of representatives of the clusters: neighbours together, by what one of
// them may give at most, and each by its own lobe to every receiver of the clusters that are left.
//
// Not in [P000] nor [Yuksel19]: of bounds the first has one per node, which does not tell of the
// strongest of its lights either.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/gather/cut_receivers.h"
#include "lobelia/trees/light_tree.h"

namespace lobelia::gather {

// A cluster of receivers as the lights see it.
struct ClusterTarget {
  CutReceivers receivers;
  int representatives = 0;  // that tell of them from afar (peaks()); 0: no light counts
  // What a light has to give them to count, as estimateNodes() tells it of all receivers.
  float least = 0;
};

class DominantLights {
 public:
  DominantLights() = default;
  // clusters: neighbours one after the other. A light counts at a cluster by what it gives each of
  // its receivers. The same for any number of threads. Incomplete when cancelled.
  DominantLights(const std::vector<ClusterTarget>& clusters,
                 std::span<const trees::LightTree> trees, const Context& context);

  // A leaf of a tree.
  struct Leaf {
    uint32_t tree, node;
    auto operator<=>(const Leaf&) const = default;
  };
  // Those that count at a cluster, sorted.
  std::span<const Leaf> of(size_t cluster) const {
    return std::span(leaves_).subspan(begins_[cluster], begins_[cluster + 1] - begins_[cluster]);
  }
  // How many lights count, cluster by cluster, and how many pairs of lights or groups of them
  // with representatives, groups of these or receivers were compared for it.
  size_t count() const { return leaves_.size(); }
  uint64_t comparisons() const { return comparisons_; }

 private:
  std::vector<Leaf> leaves_;
  std::vector<size_t> begins_;
  uint64_t comparisons_ = 0;
};

}  // namespace lobelia::gather
