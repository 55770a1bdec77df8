// The window of `lobelia view`. The build chooses one of two implementations: viewer/window, or
// viewer/no_window where GLFW or Dear ImGui is missing.
#pragma once

#include "lobelia/app/view.h"

namespace lobelia::app {

// Until the window is closed. Throws UsageError in a build without a window, RuntimeError without a
// display or without OpenGL 3.0, InputError of the scene, its data and the UI script.
ExitCode runWindow(const ViewOptions& options, const GlobalOptions& global,
                   const std::string& commandLine);

}  // namespace lobelia::app
