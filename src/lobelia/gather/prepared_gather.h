// A gather strategy made ready for one set of lights: what all of them have in common.
#pragma once

#include "lobelia/gather/gather.h"
#include "lobelia/gather/tree_export.h"

namespace lobelia::gather {

class PreparedGather {
 public:
  PreparedGather() = default;
  // Strategies have members that point at others.
  PreparedGather(const PreparedGather&) = delete;
  PreparedGather& operator=(const PreparedGather&) = delete;
  virtual ~PreparedGather() = default;
  // Adds to radiance[i] the light that receiver point i sends to its pixel (weight included), as
  // gatherAll() does, to whose statistics strategies add their own. onlyPixel:
  // GatherSettings::onlyPixel. parts: see there; null: none.
  virtual void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
                      Context& context, GatherParts* parts) const = 0;
  // The light trees that the recorded cuts of all calls of gather() are of; none where it has none
  // to show.
  virtual std::vector<ExportedTree> exportTrees() const { return {}; }
};

}  // namespace lobelia::gather
