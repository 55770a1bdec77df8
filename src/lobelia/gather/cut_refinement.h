// Cuts of light trees for one receiver, refined by upper bounds [Walter05 section 3]: the node with
// the largest bound is split until that is below a share of the estimate of all light, or the cut
// is large enough.
//
// Deviations: nodes are split in batches (bounded_cut.h), so that bounds and values are computed
// in registers and full packets of rays; the estimate that a batch is chosen by is the one before
// it. There is a tree per class of lights, and all of them are cut together.
#pragma once

#include "lobelia/gather/bounded_cut.h"
#include "lobelia/gather/receiver_nodes.h"

namespace lobelia::gather {

struct CutNode {
  uint32_t tree = 0, node = 0;
  float upper = 0;       // bound of its light's luminance; 0: a leaf, which is exact
  float power = 0;       // luminance: equal bounds go by it
  Rgb value;             // its light by the estimate
  Rgb representative;    // the light of what stands for it, alone
  float unshadowed = 0;  // NodeBound::value
  static bool less(const CutNode& a, const CutNode& b);
};

struct RefinementSettings {
  double threshold = 0.02;  // share of all light; 0: only the size limits the cut
  size_t cutSize = 1000;
  float clamp = 0;
};

class CutRefinement {
 public:
  CutRefinement(const LightForest& forest, const RefinementSettings& settings)
      : forest_(forest), settings_(settings), bounder_(forest, settings.clamp) {}

  // values(fresh, parents): sets the value of new nodes; fresh[2 i] and fresh[2 i + 1] are the
  // children of parents[i]; without parents the nodes to begin with. Afterwards cut() has the cut.
  template <class Values>
  void run(const ReceiverNodes& receiver, const Values& values) {
    begin(receiver);
    values(std::span<CutNode>(cut_.fresh), std::span<const CutNode>());
    cut_.take();
    while (split(receiver)) {
      values(std::span<CutNode>(cut_.fresh), std::span<const CutNode>(cut_.parents));
      cut_.take();
    }
    cut_.end();
  }

  std::span<const CutNode> cut() const { return cut_.items(); }
  uint64_t evaluations() const { return bounder_.evaluations(); }  // of bounds

 private:
  void begin(const ReceiverNodes& receiver);
  bool split(const ReceiverNodes& receiver);
  void boundFresh(const ReceiverNodes& receiver);

  const LightForest& forest_;
  const RefinementSettings settings_;
  NodeBounder bounder_;
  BoundedCut<CutNode> cut_;
  std::vector<uint32_t> nodes_, places_;
  std::vector<NodeBound> bounds_;
};

}  // namespace lobelia::gather
