// A set of lights, ready to be gathered by the strategy that the user chose, and merged into
// Rich-VPLs if these are the lights.
#pragma once

#include <memory>
#include <optional>

#include "lobelia/app/light_reduction.h"
#include "lobelia/gather/depth_maps.h"
#include "lobelia/gather/prepared_gather.h"

namespace lobelia::app {

class LightGather {
 public:
  // parts: as reduceParts() leaves them. When cancelled while it makes trees, slices or places, it
  // is of no use.
  LightGather(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
              const BandPlan& plan, int set, LightParts parts, const RenderOptions& options,
              Context& context);
  LightGather(const LightGather&) = delete;
  LightGather& operator=(const LightGather&) = delete;

  struct Light {
    std::vector<Rgb> direct, indirect;     // of the receiver points
    std::optional<GatherParts> layers[4];  // the first two of direct light; empty: not wanted
  };
  // wanted: parts to be kept, too. onlyPixel: GatherSettings::onlyPixel.
  Light gather(const Receivers& run, const std::optional<GatherParts>& wanted, uint32_t onlyPixel,
               Context& context) const;

  const LightParts& parts() const { return parts_; }
  // The trees of the lights that are gathered by trees (GatherParts::recordCuts).
  std::vector<gather::ExportedTree> exportTrees(bool direct) const;
  // How many receivers to gather at once.
  size_t runLength() const;

 private:
  const Tracer& tracer_;
  const GatherSettings settings_;
  const RenderOptions& options_;
  const LightParts parts_;
  // Of direct and of indirect light, where shadows are looked up.
  std::optional<gather::DepthMaps> directMaps_, indirectMaps_;
  // Of direct and of indirect light; none: all lights are gathered, or there are none.
  std::unique_ptr<gather::PreparedGather> direct_, indirect_;
};

}  // namespace lobelia::app
