// Receivers of some pixels, seen before a set of lights is gathered: what strategies look at that
// fit lights to the picture.
#pragma once

#include "lobelia/app/band_plan.h"
#include "lobelia/gather/mrcs_rows.h"

namespace lobelia::app {

// One pixel in each of as many blocks of the window, or of the pixels that are rendered.
gather::RowPixels choosePixelSample(const Camera& camera, const BandPlan& plan, size_t pixels,
                                    uint64_t seed);
// Of the first sample that gathers set `set`: the same for every run of the program. Adds nothing
// to any picture.
Receivers traceSample(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                      const BandPlan& plan, int set, const PixelSet& pixels, Context& context);

}  // namespace lobelia::app
