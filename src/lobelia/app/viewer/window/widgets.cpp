#include "lobelia/app/viewer/window/widgets.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "lobelia/film/film.h"

namespace lobelia::app {
namespace {

constexpr float kLabelShare = 0.44f;  // of a panel's width

ImVec4 onScreen(Rgb linear) {
  const auto shown = [](float x) { return encodeSrgb(std::clamp(x, 0.f, 1.f)); };
  return {shown(linear.x), shown(linear.y), shown(linear.z), 1};
}

// A swatch that opens a picker.
bool swatch(const char* id, Rgb& value) {
  bool changed = false;
  const ImVec4 shown = onScreen(value);
  if (ImGui::ColorButton(id, shown, ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                         ImVec2(ImGui::GetFrameHeight() * 1.4f, ImGui::GetFrameHeight())))
    ImGui::OpenPopup(id);
  if (ImGui::BeginPopup(id)) {
    float picked[3]{shown.x, shown.y, shown.z};
    if (ImGui::ColorPicker3("##picker", picked,
                            ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_DisplayHSV |
                                ImGuiColorEditFlags_DisplayRGB)) {
      value = Rgb(decodeSrgb(picked[0]), decodeSrgb(picked[1]), decodeSrgb(picked[2]));
      changed = true;
    }
    ImGui::EndPopup();
  }
  return changed;
}

}  // namespace

std::string shownLabel(const std::string& label) { return label.substr(0, label.find("##")); }

std::string Widgets::name(const std::string& label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shownLabel(label).c_str());
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x * kLabelShare);
  ImGui::SetNextItemWidth(-1 - left_);
  return "##" + label;
}

Touch Widgets::touched(const std::string& label, bool changed) {
  marks_.note(label);
  return {changed, ImGui::IsItemDeactivatedAfterEdit()};
}

bool Widgets::button(const std::string& label, bool enabled, float width) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label.c_str(), ImVec2(width, 0));
  ImGui::EndDisabled();
  marks_.note(shownLabel(label));
  return pressed;
}

bool Widgets::withLabel(const std::string& label, const std::string& text) {
  const std::string id = name(label);
  const float width = ImGui::GetContentRegionAvail().x - left_;
  const bool pressed = ImGui::Button((text + id).c_str(), ImVec2(std::max(width, 1.f), 0));
  marks_.note(shownLabel(label));
  return pressed;
}

Touch Widgets::checkBox(const std::string& label, bool& value) {
  const bool changed = ImGui::Checkbox(label.c_str(), &value);
  marks_.note(shownLabel(label));
  return {changed, changed};
}

Touch Widgets::slider(const std::string& label, float& value, float least, float most,
                      bool logarithmic, const char* format) {
  const std::string id = name(label);
  float edited = value;
  const bool changed =
      ImGui::SliderFloat(id.c_str(), &edited, least, most, format,
                         ImGuiSliderFlags_AlwaysClamp |
                             (logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None));
  const bool taken = changed && std::isfinite(edited) && edited != value;
  if (taken) value = edited;
  return touched(shownLabel(label), taken);
}

Touch Widgets::slider(const std::string& label, int& value, int least, int most, bool logarithmic) {
  const std::string id = name(label);
  const bool changed =
      ImGui::SliderInt(id.c_str(), &value, least, most, "%d",
                       ImGuiSliderFlags_AlwaysClamp |
                           (logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None));
  return touched(shownLabel(label), changed);
}

Touch Widgets::number(const std::string& label, float& value, float least, float most) {
  const std::string id = name(label);
  float edited = value;
  const bool changed = ImGui::DragFloat(id.c_str(), &edited, std::max(std::abs(value), 0.01f) / 100,
                                        least, most, "%.4g", ImGuiSliderFlags_AlwaysClamp);
  const bool taken = changed && std::isfinite(edited) && edited != value;
  if (taken) value = edited;
  return touched(shownLabel(label), taken);
}

Touch Widgets::numbers(const std::string& label, Vec3f& value, float speed) {
  const std::string id = name(label);
  Vec3f edited = value;
  const bool changed = ImGui::DragFloat3(id.c_str(), &edited.x, speed, 0, 0, "%.4g");
  const bool taken = changed && isFinite(edited);
  if (taken) value = edited;
  return touched(shownLabel(label), taken);
}

Touch Widgets::color(const std::string& label, Rgb& value, float most) {
  const std::string id = name(label);
  Rgb edited = value;
  ImGui::BeginGroup();
  bool changed = false;
  if (most <= 1) {
    changed = swatch((id + "swatch").c_str(), edited);
    ImGui::SameLine();
  }
  ImGui::SetNextItemWidth(-1 - left_);
  changed |= ImGui::DragFloat3(id.c_str(), &edited.x, 0.004f * std::min(most, 10.f), 0, most,
                               "%.3g", ImGuiSliderFlags_AlwaysClamp);
  ImGui::EndGroup();
  const bool taken = changed && isFinite(edited);
  if (taken) value = edited;
  return touched(shownLabel(label), taken);
}

Touch Widgets::text(const std::string& label, std::string& value, const char* hint) {
  const std::string id = name(label);
  const bool entered =
      ImGui::InputTextWithHint(id.c_str(), hint, &value, ImGuiInputTextFlags_EnterReturnsTrue);
  marks_.note(shownLabel(label));
  return {entered, entered};
}

Touch Widgets::choice(const std::string& label, int& value, std::span<const char* const> names) {
  const std::string id = name(label);
  const bool known = value >= 0 && value < static_cast<int>(names.size());
  bool changed = false;
  const bool open = ImGui::BeginCombo(id.c_str(), known ? names[static_cast<size_t>(value)] : "");
  marks_.note(shownLabel(label));
  if (open) {
    for (size_t i = 0; i < names.size(); ++i) {
      const bool chosen = static_cast<int>(i) == value;
      if (row(names[i], chosen) && !chosen) {
        value = static_cast<int>(i);
        changed = true;
      }
      if (chosen) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
  }
  return {changed, changed};
}

bool Widgets::row(const std::string& label, bool chosen) {
  const bool pressed = ImGui::Selectable(label.c_str(), chosen);
  marks_.note(shownLabel(label));
  return pressed;
}

bool Widgets::section(const char* label, bool open) {
  const bool shown = ImGui::CollapsingHeader(
      label, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  marks_.setPanel(shownLabel(label));
  marks_.note("section");
  return shown;
}

void Widgets::hint(const std::string& text) {
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip("%s", text.c_str());
}

void Widgets::quiet(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

}  // namespace lobelia::app
