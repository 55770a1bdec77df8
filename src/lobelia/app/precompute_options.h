// Options of `lobelia precompute`: those of both methods, and those of one alone.
#pragma once

#include <string>
#include <vector>

#include "lobelia/app/render_options.h"
#include "lobelia/relight/precompute.h"
#include "lobelia/transfer/precompute.h"

namespace CLI {
class App;
}

namespace lobelia::app {

struct PrecomputeOptions {
  SceneOptions scene;
  std::string method, output, stats;
  uint64_t seed = 0;
  int subdivision = 3;
  std::vector<std::string> given;  // long names of what stands on the command line

  std::string light = "environment", adaptive = "on", horizon = "ignore";
  relight::PrecomputeSettings cuts;  // what the words above and `subdivision` say left out

  std::string solver = "gather", directions = "642", rays = "auto", lobes = "one";
  int sliceRays = 144;             // of --solver scatter
  std::string work;                // folder; "": beside the output; "none"
  transfer::TransferSettings vmf;  // what the words above and `subdivision` say left out
};

void addPrecomputeOptions(CLI::App& command, PrecomputeOptions& options);
const std::vector<std::string>& precomputeMethods();
// Of the grid of directions to the eye that has so many.
int directionLevel(const PrecomputeOptions& options);
// Throws UsageError for a method that is not known, for options that the method or its solver has
// not, and such as do not go together.
void requireOfMethod(const PrecomputeOptions& options);

}  // namespace lobelia::app
