#include "lobelia/app/viewer/window_run.h"

#include <imgui.h>

#include "lobelia/app/viewer/window/surface.h"

namespace lobelia::app {

ExitCode runWindow(const ViewOptions&, const GlobalOptions&, const std::string&) {
  ImGui::CreateContext();
  Surface s({640, 480}, "x");
  for (int i = 0; i < 10; ++i) {
    s.wait(0.01);
    if (!s.drawable()) continue;
    s.beginFrame();
    ImGui::NewFrame();
    ImGui::ShowDemoWindow();
    if (i == 5) s.pretendLost();
    if (!s.endFrame()) s.recreate();
  }
  return ExitCode::done;
}

}  // namespace lobelia::app
