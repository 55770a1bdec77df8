// In place of the window, in a build without its libraries.
#include "lobelia/app/viewer/window_run.h"

namespace lobelia::app {

ExitCode runWindow(const ViewOptions&, const GlobalOptions&, const std::string&) {
  throw UsageError(
      "this build has no window: it wants GLFW 3.3 and Dear ImGui (Debian: libglfw3-dev, "
      "libimgui-dev) and a build with -DLOBELIA_VIEWER=ON; --headless with -o FILE draws without "
      "one");
}

}  // namespace lobelia::app
