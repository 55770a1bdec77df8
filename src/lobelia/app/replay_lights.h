// The trace of a pixel's receivers and the virtual lights that they gather (--replay).
#pragma once

#include "lobelia/app/render_frame.h"

namespace lobelia::app {

// Renders the pixel into film, printing the first samples or all; returns the number of samples.
int replayVirtualLights(const Frame& frame, FrameRun& run, uint32_t pixel, int maxDepth, bool all,
                        Film& film, Context& context);

}  // namespace lobelia::app
