// `lobelia view`: frames of a scene by precomputed visibility cuts (cut_frames.h) or transfer
// (transfer_frames.h), and by the methods of `render`; in a window (viewer/window_run.h) or,
// headless, into files.
#pragma once

#include <string>
#include <vector>

#include "lobelia/app/render_options.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

struct ViewOptions {
  RenderOptions render;           // of which addViewOptions() sets what a frame needs
  std::vector<std::string> data;  // `lobelia precompute`
  std::string script;             // view_script.h; "": none
  std::string uiScript;           // viewer/ui_script.h; "": none
  bool headless = false;
  size_t lightCut = 512;    // nodes
  int areaPlaces = 4;       // of each area emitter
  int bounce = -1;          // of transfer, alone; -1: all
  double rotate = 0;        // of the environment, degrees
  double rotateStep = 0;    // more with every frame
  bool plainLobes = false;  // all lobes by the light cut alone, as the paper has it
};
void addViewOptions(CLI::App& command, ViewOptions& options);
ExitCode view(const ViewOptions& options, const GlobalOptions& global,
              const std::string& commandLine);

}  // namespace lobelia::app
