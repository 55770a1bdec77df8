#include <imgui.h>

#include <numbers>

#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {
namespace {

constexpr float kDegrees = 180 / std::numbers::pi_v<float>;

void drawChoice(UiState& ui) {
  const std::vector<Camera>& cameras = ui.studio.design().cameras;
  if (cameras.size() < 2) return;
  std::vector<const char*> names;
  int now = -1;
  for (const Camera& camera : cameras) {
    if (camera.name == ui.control.camera().name) now = static_cast<int>(names.size());
    names.push_back(camera.name.empty() ? "(without a name)" : camera.name.c_str());
  }
  if (ui.widgets.choice("camera", now, names)) {
    ui.firstCamera = cameras[static_cast<size_t>(now)];
    ui.control.take(ui.firstCamera);
    ui.moved();
  }
}

}  // namespace

void drawCameraPanel(UiState& ui) {
  if (!ui.widgets.section("Camera")) return;
  ImGui::PushID("camera");
  drawChoice(ui);
  if (ui.control.camera().type == CameraType::perspective) {
    float degrees = ui.control.camera().fovX * kDegrees;
    if (ui.widgets.slider("field of view", degrees, 1, 170, false, "%.1f deg")) {
      ui.control.setFieldOfView(static_cast<double>(degrees / kDegrees));
      ui.moved();
    }
  }
  if (ui.widgets.button("reset")) {
    ui.control.take(ui.firstCamera);
    ui.moved();
  }
  ImGui::SameLine();
  if (ui.widgets.button("copy as script line"))
    ImGui::SetClipboardText(cameraLine(ui.control.camera()).c_str());
  ui.widgets.checkBox("half size while moving", ui.smallWhileMoving);
  ImGui::PopID();
}

}  // namespace lobelia::app
