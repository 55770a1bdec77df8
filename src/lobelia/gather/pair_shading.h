// Pairs of nodes that a traversal gives out, traced and shaded for the receivers of a tile.
//
// One shadow ray answers for a pair, between a receiver and a light of it that face each other,
// drawn by power: their means, which the paper takes, may lie inside of objects. Where a few draws
// find none, the pair is dark if all that it could send is below its threshold; else it is split,
// and its children ask for themselves. Then every receiver is lit by what stands for the lights, by
// its own lobe and place (Share::visibility), or all get the light of the one that the ray left
// from (Share::radiance: the paper's). Pairs of a light and a receiver get what brute force gives
// them, by the same kernels. A clamp works on all lobes of a receiver together: one lobe gets what
// it leaves of their sum.
#pragma once

#include <optional>

#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"
#include "lobelia/gather/light_forest.h"
#include "lobelia/gather/pair_traversal.h"
#include "lobelia/gather/receiver_forest.h"

namespace lobelia::gather {

enum class Share : uint8_t { visibility, radiance };

// The light that all share.
struct PairScene {
  const Tracer& tracer;
  const VirtualLights& lights;
  const PreparedLights& prepared;  // prepareLights()
  Share share = Share::visibility;
  float clamp = 0;
  uint64_t seed = 0;
};

class PairShading {
 public:
  // The receivers of a node with at most kMaxTilePoints.
  PairShading(const PairScene& scene, const ReceiverForest::Tree& receivers, uint32_t node);

  // Uses the pairs up. thresholds: luminances, of the node and those below it, in preorder; empty:
  // no pair is split.
  void add(const LightForest::Tree& lights, std::vector<TreePair>* pairs,
           std::span<const float> thresholds = {});
  // Of receiver i of the node, its weight included.
  Rgb radiance(uint32_t i) const;
  void clear();

  uint64_t rays = 0, shaded = 0, nonfinite = 0, bounded = 0;  // the last: pairs of nodes
  int64_t visibilityNs = 0, shadeNs = 0;
  std::optional<uint32_t> firstBad;    // the smallest pixel with a value that was not finite
  std::vector<uint32_t> receiverRays;  // that left from receiver i

 private:
  // A pair with the lanes of its receivers and that from which its ray leaves.
  struct Traced {
    TreePair nodes;
    uint32_t begin = 0, end = 0;
    uint32_t from = 0;
    bool found = false, visible = false;  // ends that face each other; that see each other
  };
  void addOnce(const LightForest::Tree& lights, std::vector<TreePair>* pairs);
  void splitUnanswered(const LightForest::Tree& lights, std::span<const float> thresholds,
                       std::vector<TreePair>* children);
  void trace(const LightForest::Tree& lights, std::span<Traced> pairs);
  void chooseEnds(const LightForest::Tree& lights, std::span<Traced> pairs, int attempt,
                  uint32_t* waiting);
  void traceRays(std::span<Traced> pairs, uint32_t found);
  void shadeAll(const LightForest::Tree& lights, std::span<const Traced> pairs);
  void shadeBlock(std::span<const Traced> pairs, std::span<const uint32_t> nodes);
  template <class F>
  void forMasked(const F& f) const;
  void shadeMasks();
  void computeValues();
  void addValues();
  void copyRadiance(std::span<const Traced> pairs, std::span<const uint32_t> nodes);
  void noteBad(size_t strip, uint32_t lanes);

  const PairScene& scene_;
  const ReceiverForest::Tree& receivers_;
  const uint32_t node_, first_, count_;
  Tile tile_, whole_;  // the second with all lobes, where a clamp needs them
  TileSums sums_;
  std::vector<Vec3d> copied_;  // Share::radiance; weighted
  std::vector<Traced> traced_;
  LightBlock ends_, block_;
  Vec3f rayFrom_[kBlockLights], rayTo_[kBlockLights];  // origins and directions
  bool infinite_ = false;                              // the rays do not end
  PairMasks masks_;
  PairValues values_, clamped_, free_;
};

}  // namespace lobelia::gather
