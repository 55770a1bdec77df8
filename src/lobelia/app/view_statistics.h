// `lobelia view --stats`: what its frames cost, in the form of a render's (docs/manual.md).
#pragma once

#include <string>

#include "lobelia/app/view.h"
#include "lobelia/app/view_data.h"
#include "lobelia/scene/scene.h"

namespace lobelia::app {

// Frames over the seconds of their making: loading and writing files is left out.
double framesPerSecond(const Statistics& statistics);
// data: without any, where there was none. Throws RuntimeError when the file cannot be written.
void writeViewStatistics(const ViewOptions& options, const Scene& scene, const ViewData& data,
                         const Context& context);

}  // namespace lobelia::app
