// Light: the environment, how it is turned and how bright the picture is shown; the emitters.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/studio/emitter_fields.h"
#include "lobelia/app/viewer/window/file_field.h"
#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {
namespace {

constexpr float kListRows = 4;

std::string emitterName(const Design& design, size_t emitter) {
  const Emitter& e = design.emitters[emitter];
  return fmt::format("{} ({})", e.name.empty() ? fmt::format("light {}", emitter) : e.name,
                     typeWord(e.type));
}

void drawEnvironment(UiState& ui) {
  if (fileField(ui.widgets, "environment file", ui.environmentFile, kEnvironmentEndings) ||
      ui.widgets.button("load environment", !ui.environmentFile.empty()))
    ui.studio.loadEnvironment(ui.environmentFile);
  float degrees = static_cast<float>(std::remainder(ui.studio.design().rotation, 360));
  const Touch turn = ui.widgets.slider("rotation", degrees, -180, 180, false, "%.1f deg");
  ui.edit("rotation", turn, [&](Design& d) { d.rotation = static_cast<double>(degrees); });
  if (ui.widgets.slider("exposure", ui.display.exposure, -10, 10, false, "%.2f stops"))
    ui.showDirty = true;
  if (ui.widgets.button("measure exposure again")) ui.measureCurve = true;
  ui.widgets.hint(
      "the automatic scale stays while light and materials change, until it is measured anew");
}

void drawField(UiState& ui, const EmitterFieldInfo& info) {
  const auto at = static_cast<size_t>(ui.emitter);
  Vec3f value = emitterValue(ui.studio.design().emitters[at], info.field);
  Touch touch;
  if (info.field == EmitterField::color) {
    touch = ui.widgets.color(info.label, value, info.most);
  } else if (info.values == 3) {
    touch = ui.widgets.numbers(
        info.label, value,
        info.field == EmitterField::position ? static_cast<float>(ui.control.pace()) / 100 : 0.01f);
  } else {
    touch = ui.widgets.slider(info.label, value.x, info.least, info.most, info.logarithmic);
  }
  ui.edit(fmt::format("{}: {}", emitterName(ui.studio.design(), at), info.label), touch,
          [&](Design& d) { setEmitterValue(d.emitters[at], info.field, value); });
}

// In front of the camera, half way to what it looks at.
Vec3f placeForNew(const UiState& ui) {
  const Camera camera = viewCamera(ui.view);
  const Bounds3f box = ui.studio.bounds();
  const Vec3f from = camera.toWorld.point({0, 0, 0});
  return box.empty() ? from : lerp(from, box.centre(), 0.5f);
}

std::string freeName(const Design& design, const char* stem) {
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("{}-{}", stem, number);
    if (std::none_of(design.emitters.begin(), design.emitters.end(),
                     [&](const Emitter& e) { return e.name == name; }))
      return name;
  }
}

// As bright on what is there as a lamp of 1 W/sr on a surface one unit away.
void add(UiState& ui, EmitterType type, const char* stem) {
  const Vec3f place = placeForNew(ui);
  const Bounds3f box = ui.studio.bounds();
  const float distance = box.empty() ? 1 : std::max(length(box.centre() - place), 1e-3f);
  ui.edit(fmt::format("add {}", stem), {true, true}, [&](Design& d) {
    d.emitters.push_back(newEmitter(type, freeName(d, stem), place, Rgb(3 * distance * distance)));
  });
  ui.emitter = static_cast<int>(ui.studio.design().emitters.size()) - 1;
}

void drawButtons(UiState& ui) {
  if (ui.widgets.button("add point")) add(ui, EmitterType::point, "point");
  ImGui::SameLine();
  if (ui.widgets.button("add spot")) add(ui, EmitterType::spot, "spot");
  ImGui::SameLine();
  // Area lights belong to their shapes.
  const bool removable =
      ui.emitter >= 0 &&
      ui.studio.design().emitters[static_cast<size_t>(ui.emitter)].type != EmitterType::area &&
      static_cast<uint32_t>(ui.emitter) >= ui.studio.design().sceneEmitters;
  if (ui.widgets.button("remove", removable)) {
    const int gone = ui.emitter;
    ui.edit("remove light", {true, true},
            [&](Design& d) { d.emitters.erase(d.emitters.begin() + gone); });
    ui.emitter = -1;
  }
  if (!removable) ui.widgets.hint("lights of the scene stay; they can be made black");
}

}  // namespace

void drawLightPanel(UiState& ui) {
  if (!ui.widgets.section("Light")) return;
  ui.clampChoices();
  ImGui::PushID("light");
  drawEnvironment(ui);
  ImGui::BeginChild("emitters", ImVec2(0, kListRows * ImGui::GetTextLineHeightWithSpacing()), true);
  for (size_t i = 0; i < ui.studio.design().emitters.size(); ++i)
    if (ui.widgets.row(fmt::format("{}##{}", emitterName(ui.studio.design(), i), i),
                       static_cast<int>(i) == ui.emitter))
      ui.emitter = static_cast<int>(i);
  ImGui::EndChild();
  drawButtons(ui);
  if (ui.emitter >= 0) {
    const EmitterType type = ui.studio.design().emitters[static_cast<size_t>(ui.emitter)].type;
    for (const EmitterFieldInfo& info : emitterFields(type)) drawField(ui, info);
  }
  ImGui::PopID();
}

}  // namespace lobelia::app
