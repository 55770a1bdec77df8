#include "lobelia/app/viewer/window/picture_area.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lobelia/app/studio/emitter_fields.h"
#include "lobelia/app/viewer/light_handle.h"

namespace lobelia::app {
namespace {

constexpr float kClickReach = 4;  // units; a hand is not steady
constexpr float kMarkRadius = 7;
constexpr double kWheelStep = 0.9;  // of the distance to the pivot

Vec2f mouse() { return {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y}; }
float distance(Vec2f a, Vec2f b) { return std::hypot(a.x - b.x, a.y - b.y); }

bool hasPlace(const Emitter& emitter) {
  for (const EmitterFieldInfo& info : emitterFields(emitter.type))
    if (info.field == EmitterField::position) return true;
  return false;
}

ImU32 markColor(const Emitter& emitter) {
  const Rgb light = emitterValue(emitter, EmitterField::color);
  const auto channel = [](float x) {
    return static_cast<int>(255 * encodeSrgb(std::clamp(x, 0.f, 1.f)));
  };
  return IM_COL32(channel(light.x), channel(light.y), channel(light.z), 255);
}

bool flying() {
  const auto& keys = ImGui::GetIO().KeysDown;
  for (const int key : {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E})
    if (keys[key]) return true;
  return false;
}

}  // namespace

Vec2f PictureArea::toShare(Vec2f at) const {
  return {(at.x - box_.lo.x) / (box_.hi.x - box_.lo.x),
          (at.y - box_.lo.y) / (box_.hi.y - box_.lo.y)};
}

std::optional<Vec2f> PictureArea::toScreen(const UiState& ui, Vec3f point) const {
  if (ui.view.width <= 0 || ui.view.height <= 0) return std::nullopt;
  const std::optional<Vec2f> film = project(viewCamera(ui.view), point);
  if (!film) return std::nullopt;
  return Vec2f(box_.lo.x + film->x / static_cast<float>(ui.view.width) * (box_.hi.x - box_.lo.x),
               box_.lo.y + film->y / static_cast<float>(ui.view.height) * (box_.hi.y - box_.lo.y));
}

float PictureArea::splitX(const UiState& ui) const {
  return box_.lo.x + ui.splitAt * (box_.hi.x - box_.lo.x);
}

int PictureArea::lightAt(const UiState& ui, Vec2f at) const {
  const std::vector<Emitter>& emitters = ui.studio.design().emitters;
  for (size_t i = 0; i < emitters.size(); ++i) {
    if (!hasPlace(emitters[i])) continue;
    const auto mark = toScreen(ui, emitterValue(emitters[i], EmitterField::position));
    if (mark && distance(*mark, at) <= kMarkRadius + 2) return static_cast<int>(i);
  }
  return -1;
}

void PictureArea::drawLights(UiState& ui) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const std::vector<Emitter>& emitters = ui.studio.design().emitters;
  ui.marks.setPanel("Lights");
  for (size_t i = 0; i < emitters.size(); ++i) {
    if (!hasPlace(emitters[i])) continue;
    const auto at = toScreen(ui, emitterValue(emitters[i], EmitterField::position));
    if (!at || at->x < box_.lo.x || at->x > box_.hi.x || at->y < box_.lo.y || at->y > box_.hi.y)
      continue;
    const ImVec2 centre(at->x, at->y);
    const bool chosen = static_cast<int>(i) == ui.emitter;
    draw->AddCircleFilled(centre, kMarkRadius, IM_COL32(20, 20, 20, 200));
    draw->AddCircleFilled(centre, kMarkRadius - 2.5f, markColor(emitters[i]));
    if (chosen) draw->AddCircle(centre, kMarkRadius + 3, IM_COL32(255, 255, 255, 220), 0, 1.5f);
  }
}

void PictureArea::drawSplit(UiState& ui) {
  if (!ui.split) return;
  const float x = splitX(ui);
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddLine(ImVec2(x, box_.lo.y), ImVec2(x, box_.hi.y), IM_COL32(255, 255, 255, 180));
  const float top = box_.lo.y + 6;
  const std::string& method = viewMethodNames()[static_cast<size_t>(ui.view.method)];
  const float width = ImGui::CalcTextSize(method.c_str()).x;
  for (const auto& [text, left] :
       {std::pair(method, x - width - 8),
        std::pair(std::string(ui.truth ? "truth" : "truth: not yet"), x + 8)}) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    draw->AddRectFilled(ImVec2(left - 3, top - 1), ImVec2(left + size.x + 3, top + size.y + 1),
                        IM_COL32(0, 0, 0, 150));
    draw->AddText(ImVec2(left, top), IM_COL32(255, 255, 255, 255), text.c_str());
  }
}

void PictureArea::pickAt(UiState& ui, Vec2f at, bool framing) {
  const Vec2f place = toShare(at);
  if (framing) framed_ = place;
  ui.studio.pick(place);
}

// The engine answers some frames later.
void PictureArea::takePicked(UiState& ui) {
  const std::shared_ptr<const Picked> picked = ui.studio.takePicked();
  if (!picked) return;
  const bool framing = framed_ == picked->place;
  if (framing) framed_.reset();
  if (!picked->hit) return;
  if (framing) {
    ui.control.frame(picked->bounds);
    ui.moved();
    return;
  }
  ui.control.setPivot(picked->point);
  const uint32_t material = picked->material.index;
  if (material < ui.studio.design().materials.size() && material != ui.material) {
    ui.material = material;
    ui.textureField.clear();
  }
}

void PictureArea::begin(UiState& ui) {
  const ImGuiIO& io = ImGui::GetIO();
  pressedAt_ = last_ = mouse();
  clicked_ = true;
  const int light = lightAt(ui, pressedAt_);
  if (io.MouseDown[ImGuiMouseButton_Right]) {
    drag_ = Drag::dolly;
  } else if (io.MouseDown[ImGuiMouseButton_Middle] || io.KeyShift) {
    drag_ = Drag::pan;
  } else if (io.KeyAlt) {
    drag_ = Drag::rotate;
  } else if (light >= 0) {
    ui.emitter = light;
    drag_ = Drag::light;
  } else if (ui.split && std::abs(pressedAt_.x - splitX(ui)) <= 5) {
    drag_ = Drag::split;
  } else {
    drag_ = Drag::orbit;
  }
}

void PictureArea::dragLight(UiState& ui, Vec2f by) {
  if (ui.emitter < 0 || ui.emitter >= static_cast<int>(ui.studio.design().emitters.size())) return;
  const auto at = static_cast<size_t>(ui.emitter);
  const Camera camera = viewCamera(ui.view);
  const float pixels = static_cast<float>(ui.view.width) / (box_.hi.x - box_.lo.x);
  const Vec3f from = emitterValue(ui.studio.design().emitters[at], EmitterField::position);
  const Vec3f to = ImGui::GetIO().KeyCtrl
                       ? movedAlong(camera, from, -by.y * 2 / (box_.hi.y - box_.lo.y))
                       : movedAcross(camera, from, by * pixels);
  ui.edit("move light", {true, false},
          [&](Design& d) { setEmitterValue(d.emitters[at], EmitterField::position, to); });
}

void PictureArea::dragCamera(UiState& ui, Vec2f by) {
  const double width = static_cast<double>(box_.hi.x - box_.lo.x);
  // A drag across the picture turns by half a circle.
  const double right = static_cast<double>(by.x) / width, down = static_cast<double>(by.y) / width;
  switch (drag_) {
    case Drag::orbit:
      ui.control.orbit(right * std::numbers::pi, -down * std::numbers::pi);
      break;
    case Drag::look:
      ui.control.look(right * std::numbers::pi / 2, -down * std::numbers::pi / 2);
      break;
    case Drag::pan: {
      const double widths = ui.control.widths(ui.view.width, ui.view.height);
      ui.control.pan(right * widths, down * widths);
      break;
    }
    case Drag::dolly:
      ui.control.dolly(std::exp(down * 4));
      break;
    default:
      break;
  }
  ui.moved();
}

void PictureArea::drag(UiState& ui) {
  const Vec2f now = mouse(), by = now - last_;
  if (clicked_ && distance(now, pressedAt_) < kClickReach) return;
  clicked_ = false;
  last_ = now;
  if (drag_ == Drag::dolly && flying()) drag_ = Drag::look;
  if (by == Vec2f()) return;
  const float width = box_.hi.x - box_.lo.x;
  switch (drag_) {
    case Drag::none:
      break;
    case Drag::light:
      dragLight(ui, by);
      break;
    case Drag::split:
      ui.splitAt = std::clamp((now.x - box_.lo.x) / width, 0.f, 1.f);
      ui.showDirty = true;
      break;
    case Drag::rotate: {
      const double degrees = std::remainder(
          ui.studio.design().rotation + static_cast<double>(by.x / width) * 180, 360);
      ui.edit("rotation", {true, false}, [&](Design& d) { d.rotation = degrees; });
      break;
    }
    default:
      dragCamera(ui, by);
  }
}

void PictureArea::end(UiState& ui) {
  if (clicked_ && drag_ == Drag::orbit) pickAt(ui, pressedAt_, false);
  if (drag_ == Drag::light || drag_ == Drag::rotate) ui.studio.endEdit();
  drag_ = Drag::none;
  clicked_ = false;
}

void PictureArea::fly(UiState& ui) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || io.KeyCtrl || !flying()) return;
  const double step =
      ui.control.pace() * static_cast<double>(std::min(io.DeltaTime, 0.1f)) * (io.KeyShift ? 4 : 1);
  const auto axis = [&](int plus, int minus) {
    return (io.KeysDown[plus] ? step : 0) - (io.KeysDown[minus] ? step : 0);
  };
  ui.control.fly(
      {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)});
  ui.moved();
}

void PictureArea::draw(UiState& ui, const PictureShown& picture, const MarkedBox& box,
                       float pixelScale) {
  // On whole pixels of the framebuffer, so that the picture is sharp.
  const auto snapped = [&](float x) { return std::round(x * pixelScale) / pixelScale; };
  box_ = box;
  box_.lo = {snapped(box.lo.x), snapped(box.lo.y)};
  const ImVec2 lo(box_.lo.x, box_.lo.y), size(box.hi.x - box_.lo.x, box.hi.y - box_.lo.y);
  if (size.x < 1 || size.y < 1) return;
  ImGui::SetNextWindowPos(lo);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::Begin("##picture", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground);
  ImGui::InvisibleButton("picture", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
  if (ImGui::IsItemActivated()) begin(ui);
  if (active) drag(ui);
  if (ImGui::IsItemDeactivated()) end(ui);
  if (hovered && ImGui::GetIO().MouseWheel != 0) {
    ui.control.dolly(std::pow(kWheelStep, static_cast<double>(ImGui::GetIO().MouseWheel)));
    ui.moved();
  }
  fly(ui);
  if (hovered && !ImGui::GetIO().WantTextInput && ImGui::IsKeyPressed(GLFW_KEY_F, false))
    pickAt(ui, mouse(), true);
  takePicked(ui);
  if (picture.texture)
    ImGui::GetWindowDrawList()->AddImage(picture.texture, lo, ImVec2(lo.x + size.x, lo.y + size.y));
  drawLights(ui);
  drawSplit(ui);
  ImGui::End();
  ImGui::PopStyleVar(2);
}

}  // namespace lobelia::app
