// What options and scripts of `lobelia view --headless` ask for that cannot be, or that the data do
// not have.
#pragma once

#include <vector>

#include "lobelia/app/view.h"
#include "lobelia/app/view_data.h"
#include "lobelia/app/view_script.h"

namespace lobelia::app {

// Throws InputError, at its step, where the script would write over what the run reads.
void requireOwnFiles(const ViewOptions& options, const std::vector<ScriptStep>& script);
// Throws UsageError for --bounce where no frame is by transfer.
void requireTransferFrames(const ViewOptions& options, const ViewData& data,
                           const std::vector<ScriptStep>& script);
// Says which given options change nothing, and why, and which pictures are black.
void warnOfOptions(const ViewOptions& options, const ViewData& data, Context& context);

}  // namespace lobelia::app
