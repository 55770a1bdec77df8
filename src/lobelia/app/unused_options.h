// Options of `render` that were given though they cannot apply to the rest of the command line.
#pragma once

#include <string>
#include <vector>

#include "lobelia/app/render_options.h"

namespace lobelia::app {

// The long names of the options that stand on the command line.
std::vector<std::string> givenOptions(const CLI::App& command);

// One line per option without effect: which, and why. Not errors: scripts that try several methods
// give all of them the same options.
std::vector<std::string> unusedOptions(const RenderOptions& options);

// Throws UsageError for results that would be asked for in vain: layers without an EXR to hold
// them.
void requireUsedResults(const RenderOptions& options);

}  // namespace lobelia::app
