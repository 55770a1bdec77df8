// Lights that a strategy has picked for one tile of receivers: prepared, traced and shaded block by
// block, with the exact kernels of brute force. What strategies share that pick lights tile by
// tile.
#pragma once

#include <functional>
#include <optional>

#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"
#include "lobelia/gather/light_choice.h"

namespace lobelia::gather {

// What a thread counts while it gathers.
struct GatherTally {
  uint64_t rays = 0, pairs = 0, nonfinite = 0;
  uint64_t sharedRays = 0;   // of these rays, that answer for a cluster
  uint64_t evaluations = 0;  // of nodes' bounds or estimates
  // Clusters of receivers that share lights, their receivers, what they gather of what there is.
  uint64_t clusters = 0, clusteredReceivers = 0, lights = 0, clusteredLights = 0;
  uint64_t missed = 0;  // clusters whose cuts ended by their size before CutSettings::error
  std::optional<uint32_t> firstBad;  // the smallest pixel with a pair that was not finite
  int64_t traverseNs = 0, visibilityNs = 0, shadeNs = 0;  // of threads

  void add(const GatherTally& other);
  void noteBad(uint32_t pixel);
  // Counts "shadow_rays", "shared_rays", "node_pairs_visited", "node_pairs_shaded", "nonfinite" and
  // what pixels_per_pixel_node and its like are made of; books "traverse", "visibility" and
  // "shade".
  void book(Context& context) const;
};

// Runs over [0, count) in parallel, each with a tally of its own; afterwards all are booked.
void gatherInParallel(size_t count, size_t grain, Context& context,
                      const std::function<void(size_t begin, size_t end, GatherTally*)>& run);

class ChosenGather {
 public:
  // receivers: in the tiles' order, order[i] what receiver i is called in radiance; parts: in the
  // tiles' order; null: none. prepared: prepareLights(). All must outlive it.
  ChosenGather(const Tracer& tracer, const Receivers& receivers, std::span<const uint32_t> order,
               const VirtualLights& lights, const PreparedLights& prepared,
               const GatherSettings& settings, GatherParts* parts);

  // A tile of receivers [begin, end), with what spherical lights need.
  Tile tileOf(size_t begin, size_t end) const;
  // chosen: class by class, in the order of ChosenLight::Rays. Nothing is left out but what a
  // receiver's depth forbids. seed: of the receivers from which shared rays start.
  void add(const Tile& tile, std::span<const ChosenLight> chosen, std::span<Rgb> radiance,
           GatherTally* tally, uint64_t seed = 0);

 private:
  class Agreement;
  void addBlock(const Tile& tile, std::span<const ChosenLight> chosen, uint64_t seed,
                Agreement* agreement, TileSums* sums, class TileParts* parts, GatherTally* tally);
  void write(const Tile& tile, const TileSums& sums, std::span<Rgb> radiance,
             GatherTally* tally) const;

  const Tracer& tracer_;
  const Receivers& receivers_;
  const std::span<const uint32_t> order_;
  const VirtualLights& lights_;
  const PreparedLights& prepared_;
  const GatherSettings& settings_;
  GatherParts* const parts_;
  LightBlock block_;
  PairMasks pairs_;
};

}  // namespace lobelia::gather
