// `--stats`: what a render did, as the contract's JSON object (docs/manual.md).
#pragma once

#include "lobelia/app/render_virtual_lights.h"

namespace lobelia::app {

void writeStatistics(const std::string& file, const RenderOptions& options, const Scene& scene,
                     const Film& film, const VirtualLightReport& report, const Context& context);

}  // namespace lobelia::app
