// `lobelia precompute`: light transport of a scene, kept in a file for `lobelia view`. What methods
// share; their own parts: precompute_methods.h.
#pragma once

#include "lobelia/app/precompute_options.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

// Throws UsageError, InputError, RuntimeError; nothing is written then.
ExitCode precompute(const PrecomputeOptions& options, const GlobalOptions& global);

}  // namespace lobelia::app
