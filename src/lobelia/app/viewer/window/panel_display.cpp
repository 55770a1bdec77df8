// What of a picture is shown: itself, false colours with their legend, or beside the truth.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <vector>

#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {
namespace {

constexpr int kLegendSteps = 64;
constexpr float kLegendHeight = 14;

const char* unitOf(Shown shown) {
  switch (shown) {
    case Shown::luminance:
      return "luminance";
    case Shown::illuminance:
      return "irradiance (luminance-weighted)";
    case Shown::cost:
      return "evaluations or rays per sample";
    case Shown::samples:
      return "samples per pixel";
    case Shown::error:
      return "relative error";
    case Shown::picture:
      break;
  }
  return "";
}

void drawLegend(const UiState& ui) {
  const std::vector<uint8_t> colors = legendColors(kLegendSteps);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  for (int i = 0; i < kLegendSteps; ++i) {
    const size_t c = static_cast<size_t>(i) * 4;
    const float x0 = at.x + width * static_cast<float>(i) / kLegendSteps,
                x1 = at.x + width * static_cast<float>(i + 1) / kLegendSteps;
    draw->AddRectFilled(ImVec2(x0, at.y), ImVec2(x1 + 0.5f, at.y + kLegendHeight),
                        IM_COL32(colors[c], colors[c + 1], colors[c + 2], 255));
  }
  ImGui::Dummy(ImVec2(width, kLegendHeight));
  ImGui::TextUnformatted(fmt::format("{:.3g}", ui.legendLeast).c_str());
  const std::string most = fmt::format("{:.3g}", ui.legendMost);
  ImGui::SameLine(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(most.c_str()).x);
  ImGui::TextUnformatted(most.c_str());
  ImGui::TextDisabled("%s", unitOf(ui.display.shown));
}

void drawRange(UiState& ui) {
  if (ui.widgets.checkBox("fixed range", ui.display.fixedRange)) {
    ui.showDirty = true;
    ui.display.least = ui.legendLeast;
    ui.display.most = std::max(ui.legendMost, ui.legendLeast + 1e-6f);
  }
  if (ui.display.fixedRange) {
    if (ui.widgets.number("from", ui.display.least, 0, 1e9f)) ui.showDirty = true;
    if (ui.widgets.number("to", ui.display.most, 0, 1e9f)) ui.showDirty = true;
    ui.display.most = std::max(ui.display.most, ui.display.least + 1e-9f);
  }
  if (ui.widgets.checkBox("logarithmic", ui.display.logarithmic)) ui.showDirty = true;
}

}  // namespace

void drawDisplayPanel(UiState& ui) {
  if (!ui.widgets.section("Display")) return;
  ImGui::PushID("display");
  std::vector<const char*> names;
  for (const std::string& name : shownNames()) names.push_back(name.c_str());
  names[static_cast<size_t>(Shown::picture)] = "picture";
  int shown = static_cast<int>(ui.display.shown);
  if (ui.widgets.choice("show", shown, names)) {
    ui.display.shown = static_cast<Shown>(shown);
    ui.showDirty = true;
  }
  if (ui.display.shown != Shown::picture) {
    drawLegend(ui);
    drawRange(ui);
  }
  if (ui.widgets.checkBox("split: the truth on the right", ui.split)) ui.showDirty = true;
  if (ui.split) {
    if (ui.widgets.slider("split at", ui.splitAt, 0, 1)) ui.showDirty = true;
    if (ui.truth)
      ui.widgets.quiet(fmt::format("truth: {} samples, error about {:.2g} %", ui.truth->samples,
                                   ui.truth->relativeError * 100));
    else
      ui.widgets.quiet("the truth begins when the first picture is there");
  }
  ImGui::PopID();
}

}  // namespace lobelia::app
