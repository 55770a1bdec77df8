// LightSlice [Ou11]: a gather strategy for many lights. The picture is cut into slices of receivers
// near each other and turned alike (receiver_slices.h). One receiver of each gathers all lights,
// visibility included: its row of the transport matrix. Lights are clustered by all rows as in
// matrix row-column sampling, and for every slice these clusters are split further by the rows of
// the slice and its neighbours (slice_clusters.h); the receivers of the slice gather one light of
// each cluster.
//
// Given any clusters, the mean over the draws is the light of all lights at every receiver.
// Deviations: slices are made from a sample of the receivers, and where that is empty all receivers
// gather lights drawn by power; other deviations are named in the
// files above.
#pragma once

#include <optional>

#include "lobelia/gather/light_choice.h"
#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/receiver_slices.h"
#include "lobelia/gather/sphere.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

struct SliceSettings {
  GatherSettings gather;
  size_t slices = 400;
  size_t columns = 400;                 // lights that a slice gathers, at most
  size_t rows = 32;                     // that its clusters are made for: its own and the nearest
  double globalShare = 0.5;             // of its clusters, made by all rows
  uint64_t memory = uint64_t{2} << 30;  // bytes that rows and clusters may take
  uint64_t seed = 0;
};

// It keeps references to lights and tracer.
class LightSlices : public PreparedGather {
 public:
  // sample: some receivers of the picture. Counts "shadow_rays", "node_pairs_shaded" and
  // "nonfinite" of the rows; books seconds to "rows" and "cluster". Throws UsageError when the rows
  // do not fit into the memory. When cancelled, it is of no use.
  LightSlices(const Tracer& tracer, const Receivers& sample, const VirtualLights& lights,
              const SliceSettings& settings, Context& context);

  // As gatherAll(), whose mean this has. A slice's receivers count as a cluster (GatherTally).
  // onlyPixel: GatherSettings::onlyPixel.
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts = nullptr) const override;

  size_t sliceCount() const { return chosen_.size(); }
  // That a slice gathers, on average.
  double lightsPerSlice() const;

 private:
  void chooseAll();
  void chooseByPower();
  void choose(const Tracer& tracer, const Receivers& sample, Context& context);

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const SliceSettings settings_;
  const LightNumbers numbers_;
  std::optional<ReceiverSlices> slices_;          // none: all receivers gather all lights
  std::vector<std::vector<ChosenLight>> chosen_;  // of each slice
  PreparedLights prepared_;
};

}  // namespace lobelia::gather
