// Cut through all pairs of nodes of light trees and of a pixel's gather tree, refined by upper
// bounds [Walter06 section 3]: the pair with the largest bound is split on one side until that is
// below a share of the estimate of all of the pixel's light, or there are enough pairs.
//
// The side is the one that extends further by places and directions (pair_traversal.h), whose bound
// so shrinks more; the paper compares the sizes of boxes and direction cones, too.
//
// Deviations: pairs are split in batches (bounded_cut.h); there is a tree
// per class of lights, and all of them are cut together.
#pragma once

#include "lobelia/gather/bounded_cut.h"
#include "lobelia/gather/gather_tree.h"
#include "lobelia/gather/light_forest.h"

namespace lobelia::gather {

struct ProductPair {
  uint32_t tree = 0, lights = 0;  // node of a light tree
  uint32_t receivers = 0;         // node of the gather tree
  uint32_t receiver = 0;          // the leaf that stands for it
  float upper = 0;                // bound of its light's luminance; 0: one light at one receiver
  float power = 0;                // luminance: equal bounds go by it
  Rgb value;                      // its light by the estimate
  Rgb representative;             // the light of what stands for both nodes, alone
  static bool less(const ProductPair& a, const ProductPair& b);
};

struct ProductSettings {
  double threshold = 0.02;  // share of all light; 0: only the number limits the cut
  size_t cutSize = 8000;    // pairs
  float clamp = 0;
};

class ProductCut {
 public:
  ProductCut(const LightForest& forest, const ProductSettings& settings)
      : forest_(forest), settings_(settings) {}

  // values(fresh, parents): sets the value of new pairs; fresh[2 i] and fresh[2 i + 1] are the
  // children of parents[i]; without parents the pairs to begin with. Afterwards pairs() has the
  // cut.
  template <class Values>
  void run(const GatherTree& receivers, const Values& values) {
    begin();
    values(std::span<ProductPair>(cut_.fresh), std::span<const ProductPair>());
    boundFresh(receivers);
    cut_.take();
    while (split(receivers)) {
      values(std::span<ProductPair>(cut_.fresh), std::span<const ProductPair>(cut_.parents));
      boundFresh(receivers);
      cut_.take();
    }
    cut_.end();
  }

  void clear() { cut_.clear(); }
  std::span<const ProductPair> pairs() const { return cut_.items(); }
  uint64_t evaluations() const { return evaluations_; }  // of bounds

 private:
  void begin();
  bool split(const GatherTree& receivers);
  bool refinesLights(const GatherTree& receivers, const ProductPair& pair) const;
  void boundFresh(const GatherTree& receivers);

  const LightForest& forest_;
  const ProductSettings settings_;
  WholeBounds bounder_;
  uint64_t evaluations_ = 0;
  BoundedCut<ProductPair> cut_;
  std::vector<NodePair> nodes_;
  std::vector<uint32_t> places_;
  std::vector<float> uppers_;
};

}  // namespace lobelia::gather
