// By which method pictures are made, and where their time goes.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {
namespace {

constexpr std::array<const char*, 5> kLightCuts{"128", "256", "512", "1024", "2048"};
constexpr int kMostSamples = 1 << 14;
constexpr int kMostLights = 1'000'000;
constexpr int kMostDepth = 32;

void drawCuts(UiState& ui) {
  int chosen = -1;
  for (size_t i = 0; i < kLightCuts.size(); ++i)
    if (std::to_string(ui.view.lightCut) == kLightCuts[i]) chosen = static_cast<int>(i);
  if (ui.widgets.choice("light cut", chosen, kLightCuts))
    ui.view.lightCut = std::stoul(kLightCuts[static_cast<size_t>(chosen)]);
  ui.widgets.hint("nodes of the light's cut: more are slower and more exact");
  ui.widgets.checkBox("finer light for narrow lobes", ui.view.refined);
}

// Of light by the number of its bounces.
void drawTransfer(UiState& ui) {
  std::vector<std::string> names{"all", "direct"};
  const int passes = ui.studio.transferPasses();
  for (int i = 1; i < passes; ++i) names.push_back(fmt::format("bounce {}", i));
  std::vector<const char*> words;
  for (const std::string& name : names) words.push_back(name.c_str());
  int chosen = ui.view.bounce + 1;
  if (ui.widgets.choice("light", chosen, words)) ui.view.bounce = chosen - 1;
  ui.widgets.hint("all, or what has so many reflections before the surface that is seen");
}

void drawProgressive(UiState& ui) {
  ui.widgets.slider("samples", ui.view.spp, 1, kMostSamples, true);
  ui.widgets.hint("of a pixel, after which the picture is done");
  if (ui.view.method != ViewMethod::path && ui.view.method != ViewMethod::vsgl) {
    int lights = static_cast<int>(ui.view.lightCount);
    if (ui.widgets.slider("lights", lights, 0, kMostLights, true))
      ui.view.lightCount = static_cast<uint64_t>(lights);
    ui.widgets.hint("of a pass; 0: as many as a quick pass has");
  }
  ui.widgets.slider("depth", ui.view.maxDepth, 0, kMostDepth);
  ui.widgets.hint("most edges of a light's path: 2 is direct light; 0: as the scene says");
}

const char* whyNot(const Studio& studio, ViewMethod method) {
  if (method == ViewMethod::cuts && !studio.hasCuts())
    return "cuts want precomputed visibility: `lobelia precompute SCENE --method cuts -o FILE`, "
           "then `lobelia view SCENE --data FILE`";
  if (method == ViewMethod::transfer && studio.transferPasses() == 0)
    return "transfer wants to be precomputed: `lobelia precompute SCENE --method vmf -o FILE`, "
           "then `lobelia view SCENE --data FILE`";
  return nullptr;
}

void drawMethods(UiState& ui) {
  std::vector<const char*> names;
  for (const std::string& name : viewMethodNames()) names.push_back(name.c_str());
  int chosen = static_cast<int>(ui.view.method);
  if (ui.widgets.choice("method", chosen, names)) {
    const auto method = static_cast<ViewMethod>(chosen);
    if (const char* why = whyNot(ui.studio, method)) {
      ui.notes.add(Severity::warning, why);
    } else {
      ui.view.method = method;
    }
  }
}

std::string milliseconds(double seconds) {
  const double ms = seconds * 1e3;
  return ms < 10 ? fmt::format("{:.1f} ms", ms) : fmt::format("{:.0f} ms", ms);
}

// One bar for each stage, as long as its share of the frame.
void drawTimes(const Picture& picture) {
  double all = 0;
  for (const auto& [stage, seconds] : picture.parts) all += seconds;
  if (!(all > 0)) return;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() + 2;
  for (const auto& [stage, seconds] : picture.parts) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float share = static_cast<float>(seconds / all);
    draw->AddRectFilled(at, ImVec2(at.x + width, at.y + height),
                        ImGui::GetColorU32(ImGuiCol_FrameBg), 2);
    draw->AddRectFilled(at, ImVec2(at.x + width * share, at.y + height), IM_COL32(62, 98, 140, 255),
                        2);
    const std::string text = milliseconds(seconds);
    draw->AddText(ImVec2(at.x + 5, at.y + 1), ImGui::GetColorU32(ImGuiCol_Text), stage.c_str());
    draw->AddText(ImVec2(at.x + width - 5 - ImGui::CalcTextSize(text.c_str()).x, at.y + 1),
                  ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    ImGui::Dummy(ImVec2(width, height));
  }
}

bool isInOneGo(const Picture& picture) {
  const std::optional<ViewMethod> method = viewMethod(picture.method);
  return method && inOneGo(*method);
}

void drawFigures(const Picture& picture) {
  if (isInOneGo(picture)) {
    ImGui::TextUnformatted(
        fmt::format("{:.1f} frames/s, {}", picture.framesPerSecond(), milliseconds(picture.seconds))
            .c_str());
  } else {
    ImGui::Text("%d passes, %d samples, %.3g s", picture.passes, picture.samples,
                picture.secondsInAll);
    if (picture.relativeError > 0)
      ImGui::Text("error about %.2g %%", picture.relativeError * 100);
    else
      ImGui::TextDisabled("error: after two passes");
  }
  ImGui::Text("%d x %d pixels", picture.film.width, picture.film.height);
}

}  // namespace

void drawMethodPanel(UiState& ui) {
  if (!ui.widgets.section("Method")) return;
  ImGui::PushID("method");
  drawMethods(ui);
  if (ui.view.method == ViewMethod::cuts) {
    drawCuts(ui);
  } else if (ui.view.method == ViewMethod::transfer) {
    drawTransfer(ui);
  } else {
    drawProgressive(ui);
  }
  ImGui::PopID();
}

void drawTimePanel(UiState& ui) {
  if (!ui.widgets.section("Time") || !ui.picture) return;
  drawFigures(*ui.picture);
  drawTimes(*ui.picture);
}

std::string statusText(const UiState& ui) {
  const std::string& method = viewMethodNames()[static_cast<size_t>(ui.view.method)];
  if (ui.studio.openFiles() > 0) return method + ": reading or writing a file";
  if (!ui.picture) return method + ": drawing the first picture";
  const Picture& p = *ui.picture;
  if (isInOneGo(p)) return fmt::format("{}: {:.1f} frames/s", p.method, p.framesPerSecond());
  if (p.quick) return fmt::format("{}: a first look", p.method);
  const bool done = p.samples >= ui.view.spp;
  std::string out =
      done ? fmt::format("{}: done, {} samples", p.method, p.samples)
           : fmt::format("{}: converging, {} of {} samples", p.method, p.samples, ui.view.spp);
  if (p.relativeError > 0) out += fmt::format(", error about {:.2g} %", p.relativeError * 100);
  return out;
}

}  // namespace lobelia::app
