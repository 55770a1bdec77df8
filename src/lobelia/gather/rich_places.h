// Where Rich-VPLs lie [Simon15 section 4]: at places drawn from those of the virtual lights in
// proportion to the light that they send to the picture, sensor importance times radiance. Every
// other light is joined to the nearest place with a normal like its own, so that none is lost.
//
// Deviations from the paper, which draws places and estimates their incident radiance from photons
// around them: the particles are a given set of lights, and a light is joined to one place whole,
// which keeps the sum of their powers. Importance is what a sample of the picture's receivers gets
// of each light, with its shadow rays, by a geometry term that is limited as if every place were
// spread over its share of the scene; half of the weight goes by power, for what the sample
// does not see. Places are drawn without replacement, evenly along a curve through space.
#pragma once

#include <vector>

#include "lobelia/gather/light_choice.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

struct RichPlaces {
  static constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> light;    // at each place, by LightNumbers
  std::vector<uint32_t> placeOf;  // of each light; kNone: neither diffuse nor glossy
};

struct RichPlaceSettings {
  GatherSettings gather;
  size_t count = 1;  // of places, at most; more where there are more light groups
  uint64_t seed = 0;
};

// sample: some receivers of the picture; none: places by power. Lights of different groups are
// never joined. Counts "shadow_rays", "node_pairs_shaded" and "nonfinite" of the sample; books
// seconds to "rows" and "cluster". When cancelled, of no use. The same for any number of threads.
RichPlaces chooseRichPlaces(const Tracer& tracer, const Receivers& sample,
                            const VirtualLights& lights, const LightNumbers& numbers,
                            const RichPlaceSettings& settings, Context& context);

// Where a diffuse or glossy light lies and which way its surface faces.
struct LightSite {
  Vec3f p, n;
};
LightSite siteOf(const VirtualLights& lights, const ChosenLight& light);

}  // namespace lobelia::gather
