// What options of `lobelia view` ask for that the data do not have.
#pragma once

#include <vector>

#include "lobelia/app/view.h"
#include "lobelia/app/view_data.h"
#include "lobelia/app/view_script.h"

namespace lobelia::app {

// Throws UsageError for --bounce where no frame is by transfer.
void requireTransferFrames(const ViewOptions& options, const ViewData& data,
                           const std::vector<ScriptStep>& script);
// Says which given options change nothing, and why, and which pictures are black.
void warnOfOptions(const ViewOptions& options, const ViewData& data, Context& context);

}  // namespace lobelia::app
