// The methods of `lobelia precompute`: each loads the scene, makes its data, saves them, says what
// they are and writes the statistics.
#pragma once

#include "lobelia/app/precompute_options.h"
#include "lobelia/base/context.h"

namespace lobelia::app {

// Visibility cuts (relight/). Throws Cancelled.
void precomputeCuts(const PrecomputeOptions& options, Context& context);
// Glossy transfer (transfer/). Throws Cancelled; what is done so far stays in the work folder.
void precomputeVmf(const PrecomputeOptions& options, Context& context);

// The folder of --method vmf for what is done so far; "": none.
std::string workFolder(const PrecomputeOptions& options);

}  // namespace lobelia::app
