// `lobelia precompute`: light transport of a scene's geometry, kept in a file for `lobelia view`.
#pragma once

#include <string>

#include "lobelia/app/render_options.h"
#include "lobelia/base/error.h"
#include "lobelia/relight/precompute.h"

namespace CLI {
class App;
}

namespace lobelia::app {

struct PrecomputeOptions {
  SceneOptions scene;
  std::string method, output, stats;
  std::string light = "environment", adaptive = "on", horizon = "ignore";
  relight::PrecomputeSettings settings;
  uint64_t seed = 0;
};

void addPrecomputeOptions(CLI::App& command, PrecomputeOptions& options);
ExitCode precompute(const PrecomputeOptions& options, const GlobalOptions& global);

}  // namespace lobelia::app
