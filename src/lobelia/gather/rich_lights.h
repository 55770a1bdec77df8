// Rich-VPLs [Simon15]: a light model for many glossy lights. Few places stand for all diffuse
// and glossy lights (rich_places.h); each sends out, over directions, what all the lights joined to
// it send (rich_radiance.h), and every receiver gathers all places with one shadow ray each.
//
// Biased: lights are moved to their place and turned to its surface. It becomes the sum over all
// lights as places and the detail of their directions grow.
//
// Deviations from the paper, whose particles are photons of a light pass of its own: they are the
// virtual lights of the model 'glossy'; lights of other classes (omni, directional,
// spherical) are gathered one by one as they are. A receiver that may not gather lights of all
// depths takes from each place the share of its power that it may. Other deviations are named in
// the files above. Everything runs on the CPU, where [P000 section 7] has it on a GPU.
#pragma once

#include <memory>

#include "lobelia/gather/prepared_gather.h"
#include "lobelia/gather/rich_places.h"
#include "lobelia/gather/rich_radiance.h"

namespace lobelia::gather {

struct RichSettings {
  GatherSettings gather;
  size_t lights = 1000;  // places, at most; more where there are more light groups
  RichForm form = RichForm::vmf;
  int texels = 16;   // along an edge of a cube, even
  int lobes = 8;     // of a mixture
  float spread = 1;  // times the lights' squared distances to their place: least squared distance
  uint64_t memory = uint64_t{2} << 30;  // bytes that places may take
  uint64_t seed = 0;
};

// It keeps references to the tracer.
class RichLights : public PreparedGather {
 public:
  // sample: some receivers of the picture. Counts and seconds of chooseRichPlaces(); counts
  // "rich_lights" and "rich_bytes", books seconds to "trees". Throws UsageError when the places do
  // not fit into the memory. When cancelled, it is of no use.
  RichLights(const Tracer& tracer, const Receivers& sample, const VirtualLights& lights,
             const RichSettings& settings, Context& context);

  // As gatherAll().
  void gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
              Context& context, GatherParts* parts = nullptr) const override;

  const RichRadiance& radiance() const { return *radiance_; }
  // Of the rich lights: diffuse lights of VirtualLights, parallel to radiance().
  const VirtualLights& lights() const { return lights_; }

 private:
  class Builder;

  const Tracer& tracer_;
  const RichSettings settings_;
  VirtualLights lights_;  // places as diffuse lights, and lights of other classes
  std::unique_ptr<RichRadiance> radiance_;
};

}  // namespace lobelia::gather
