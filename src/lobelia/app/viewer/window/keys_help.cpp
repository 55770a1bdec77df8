#include "lobelia/app/viewer/window/keys_help.h"

#include <imgui.h>

#include <utility>

namespace lobelia::app {
namespace {

constexpr std::pair<const char*, const char*> kKeys[]{
    {"left drag", "orbit around the pivot"},
    {"middle or Shift + left drag", "pan"},
    {"wheel, right drag", "nearer, farther"},
    {"W A S D, Q E", "fly: ahead, left, back, right, down, up (Shift: faster)"},
    {"right drag while flying", "look around"},
    {"click", "select the material under the cursor; the pivot goes there"},
    {"F", "look at the whole of what is under the cursor"},
    {"R", "the scene's camera again"},
    {"C", "copy the camera as a line of a script"},
    {"Alt + left drag", "turn the light from infinity"},
    {"drag a light's mark", "move it across the view (Ctrl: along it)"},
    {"drag the split line", "more of the picture, or of the truth"},
    {"Ctrl + Z, Ctrl + Shift + Z", "undo, redo"},
    {"Ctrl + S", "save the design"},
    {"drop a file", "an environment (.hdr, .exr), a texture, a design (.xml)"},
    {"Tab", "hide or show the panels"},
    {"F1 or H", "this overview"},
};

}  // namespace

void drawKeysHelp(bool& open) {
  if (!open) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x / 2, size.y / 2), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowFocus();
  if (ImGui::Begin("Mouse and keys", &open,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                       ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings) &&
      ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
    for (const auto& [keys, text] : kKeys) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(text);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace lobelia::app
