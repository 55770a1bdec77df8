#include "lobelia/app/viewer/window/style.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

namespace lobelia::app {
namespace {

// A face with more than ASCII, where the system has it; else Dear ImGui's own.
constexpr const char* kFace = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float kTextSize = 14;  // pixels at scale 1

const ImWchar* letters() {
  static const ImWchar ranges[]{0x0020, 0x024F, 0x0370, 0x03FF, 0x0400, 0x04FF,
                                0x2010, 0x2027, 0x2190, 0x21FF, 0};
  return ranges;
}

void addFont(float scale, float pixelScale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  const float pixels = kTextSize * scale * pixelScale;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(kFace, ignored) ||
      !io.Fonts->AddFontFromFileTTF(kFace, pixels, nullptr, letters())) {
    ImFontConfig config;
    config.SizePixels = std::max(pixels - 1, 8.f);
    io.Fonts->AddFontDefault(&config);
  }
  io.FontGlobalScale = 1 / pixelScale;
}

ImVec4 grey(float value, float alpha = 1) { return {value, value, value, alpha}; }

void addColors(ImGuiStyle& style) {
  const ImVec4 accent(0.36f, 0.56f, 0.78f, 1), strong(0.44f, 0.66f, 0.90f, 1);
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = grey(0.90f);
  c[ImGuiCol_TextDisabled] = grey(0.58f);
  c[ImGuiCol_WindowBg] = grey(0.13f);
  c[ImGuiCol_ChildBg] = grey(0.11f);
  c[ImGuiCol_PopupBg] = grey(0.15f, 0.98f);
  c[ImGuiCol_Border] = grey(0.26f);
  c[ImGuiCol_FrameBg] = grey(0.21f);
  c[ImGuiCol_FrameBgHovered] = grey(0.27f);
  c[ImGuiCol_FrameBgActive] = grey(0.31f);
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = grey(0.17f);
  c[ImGuiCol_CheckMark] = strong;
  c[ImGuiCol_SliderGrabActive] = ImVec4(0.30f, 0.48f, 0.68f, 1);
  c[ImGuiCol_SliderGrab] = ImVec4(0.24f, 0.38f, 0.55f, 1);
  c[ImGuiCol_Button] = grey(0.25f);
  c[ImGuiCol_ButtonHovered] = grey(0.32f);
  c[ImGuiCol_ButtonActive] = grey(0.38f);
  c[ImGuiCol_Header] = grey(0.23f);
  c[ImGuiCol_HeaderHovered] = grey(0.29f);
  c[ImGuiCol_HeaderActive] = grey(0.34f);
  c[ImGuiCol_PlotHistogram] = accent;
  c[ImGuiCol_TextSelectedBg] = ImVec4(accent.x, accent.y, accent.z, 0.45f);
}

}  // namespace

void applyStyle(float scale, float pixelScale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  addColors(style);
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.ItemSpacing = {6, 4};
  style.FramePadding = {6, 3};
  style.IndentSpacing = 12;
  style.ScrollbarSize = 12;
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
  addFont(scale, pixelScale);
}

}  // namespace lobelia::app
