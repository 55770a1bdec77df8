#include "lobelia/app/viewer/window/ui.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/viewer/window/keys_help.h"
#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {
namespace {

constexpr float kPanelLetters = 22;     // a panel's width in letters' heights
constexpr float kLeastPicture = 0.25f;  // of the window's width; narrower, and the panels give way

bool pressed(int key) { return ImGui::IsKeyPressed(key, false); }

}  // namespace

void Ui::handleKeys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput) return;
  UiState& ui = state_;
  if (io.KeyCtrl) {
    if (ImGui::IsKeyPressed(GLFW_KEY_Z)) {
      if (io.KeyShift)
        ui.studio.redo();
      else
        ui.studio.undo();
    }
    if (ImGui::IsKeyPressed(GLFW_KEY_Y)) ui.studio.redo();
    if (pressed(GLFW_KEY_S) && !ui.designFile.empty()) ui.saveDesign();
    return;
  }
  if (pressed(GLFW_KEY_TAB)) ui.panels = !ui.panels;
  if (pressed(GLFW_KEY_F1) || pressed(GLFW_KEY_H)) ui.help = !ui.help;
  if (pressed(GLFW_KEY_ESCAPE)) ui.help = false;
  if (pressed(GLFW_KEY_R)) {
    ui.control.take(ui.firstCamera);
    ui.moved();
  }
  if (pressed(GLFW_KEY_C)) {
    ImGui::SetClipboardText(cameraLine(ui.control.camera()).c_str());
    ui.notes.add(Severity::info, "the camera is in the clipboard, as a line of a script");
  }
}

void Ui::layOut() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::round(kPanelLetters * ImGui::GetFontSize());
  const bool shown = state_.panels && size.x - 2 * width >= kLeastPicture * size.x;
  box_ = {{shown ? width : 0, 0}, {shown ? size.x - width : size.x, size.y}, true};
}

void Ui::drawSide(const char* name, float x, float width, bool left) {
  ImGui::SetNextWindowPos(ImVec2(x, 0));
  ImGui::SetNextWindowSize(ImVec2(width, ImGui::GetIO().DisplaySize.y));
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  if (left) {
    drawHistoryPanel(state_);
    drawMaterialPanel(state_);
    drawCameraPanel(state_);
  } else {
    drawMethodPanel(state_);
    drawDisplayPanel(state_);
    drawLightPanel(state_);
    drawFilesPanel(state_);
    drawTimePanel(state_);
  }
  ImGui::End();
}

// Over the picture's upper left corner.
void Ui::drawStatus() {
  const std::string text = statusText(state_);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float margin = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 at(box_.lo.x + margin, box_.lo.y + margin);
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->PushClipRect(ImVec2(box_.lo.x, box_.lo.y), ImVec2(box_.hi.x, box_.hi.y));
  draw->AddRectFilled(ImVec2(at.x - 4, at.y - 2), ImVec2(at.x + size.x + 4, at.y + size.y + 2),
                      IM_COL32(0, 0, 0, 150), 3);
  draw->AddText(at, IM_COL32(235, 235, 235, 255), text.c_str());
  draw->PopClipRect();
}

// The picture fills its place, pixel for pixel.
void Ui::wantPicture(float pixelScale, int largest) {
  UiState& ui = state_;
  const bool small = ui.smallWhileMoving && ui.moving();
  const auto pixels = [&](float length) {
    const float whole = std::round(length * pixelScale) * (small ? 0.5f : 1.f);
    return std::clamp(static_cast<int>(whole), 1, largest);
  };
  ui.view.width = pixels(box_.hi.x - box_.lo.x);
  ui.view.height = pixels(box_.hi.y - box_.lo.y);
  ui.view.camera = ui.control.fitted(ui.view.width, ui.view.height);
  ui.view.truth = ui.split;
  ui.view.white = ui.display.shown == Shown::illuminance;
  ui.view.cost = ui.display.shown == Shown::cost;
  // What is wanted again would cancel what is being drawn for it.
  const ViewState& now = ui.studio.view();
  if (!samePicture(now, ui.view) || !sameTruth(now, ui.view) || now.spp != ui.view.spp ||
      now.truth != ui.view.truth)
    ui.studio.setView(ui.view);
}

void Ui::draw(const PictureShown& picture, float pixelScale, int largest) {
  state_.marks.beginFrame();
  state_.clampChoices();
  handleKeys();
  layOut();
  area_.draw(state_, picture, box_, pixelScale);
  const float right = ImGui::GetIO().DisplaySize.x;
  if (box_.lo.x > 0) {
    drawSide("##left", 0, box_.lo.x, true);
    drawSide("##right", box_.hi.x, right - box_.hi.x, false);
  }
  drawStatus();
  for (const StudioMessage& message : state_.studio.takeMessages())
    state_.notes.add(message.severity, message.text);
  state_.notes.draw(box_, state_.marks);
  drawKeysHelp(state_.help);
  wantPicture(pixelScale, largest);
}

}  // namespace lobelia::app
