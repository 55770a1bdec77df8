// The commands that need no page of their own.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

struct CompareOptions {
  std::string image, reference, reference2, mask, diff;
  bool json = false;
};
ExitCode compareImages(const CompareOptions& options, const GlobalOptions& global);

struct FitOptions {
  std::string table, output;
  int lobes = 3;
  bool json = false;
};
ExitCode fit(const FitOptions& options, const GlobalOptions& global);

struct InfoOptions {
  SceneOptions scene;
  bool json = false;
};
ExitCode info(const InfoOptions& options, const GlobalOptions& global);

struct ConvertOptions {  // `scene` (built-in only) and `convert` (any)
  SceneOptions scene;
  std::string folder;
};
ExitCode convert(const ConvertOptions& options, const GlobalOptions& global);

}  // namespace lobelia::app
