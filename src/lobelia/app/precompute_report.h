// What methods of `lobelia precompute` say about their data.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lobelia/app/precompute_options.h"
#include "lobelia/base/context.h"
#include "lobelia/scene/scene.h"

namespace lobelia::app {

// The contract's keys: those of rendering are 0 here, the rest is filled in from the context.
// counts without those of the method.
nlohmann::ordered_json contractStatistics(const PrecomputeOptions& options, const Scene& scene,
                                          const Context& context);
// Does nothing without --stats.
void writeStatistics(const PrecomputeOptions& options, const nlohmann::ordered_json& statistics);

uint64_t outputBytes(const PrecomputeOptions& options);  // 0: of a device
double ratio(double a, double b);                        // 0 where b is not above 0

}  // namespace lobelia::app
