// Designs, screenshots, and the history of edits.
#include <fmt/format.h>
#include <imgui.h>

#include "lobelia/app/viewer/window/file_field.h"
#include "lobelia/app/viewer/window/panels.h"

namespace lobelia::app {

void drawHistoryPanel(UiState& ui) {
  const History& history = ui.studio.history();
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  ui.marks.setPanel("History");
  if (ui.widgets.button("undo", history.canUndo(), width)) ui.studio.undo();
  if (history.canUndo()) ui.widgets.hint("undo: " + history.undoName());
  ImGui::SameLine();
  if (ui.widgets.button("redo", history.canRedo(), width)) ui.studio.redo();
  if (history.canRedo()) ui.widgets.hint("redo: " + history.redoName());
}

void drawFilesPanel(UiState& ui) {
  if (!ui.widgets.section("Files")) return;
  ImGui::PushID("files");
  fileField(ui.widgets, "design file", ui.designFile, kDesignEndings);
  const bool named = !ui.designFile.empty();
  if (ui.widgets.button("save design", named)) ui.saveDesign();
  ui.widgets.hint("what differs from the scene, for `lobelia render SCENE --design FILE`");
  ImGui::SameLine();
  if (ui.widgets.button("load design", named)) ui.studio.loadDesign(ui.designFile);
  fileField(ui.widgets, "picture file", ui.screenshotFile, kPictureEndings);
  if (ui.widgets.button("save picture", !ui.screenshotFile.empty()))
    ui.studio.screenshot(ui.screenshotFile, ui.shownDisplay());
  ui.widgets.hint(".exr: linear values; .png: as it is shown");
  ImGui::PopID();
}

}  // namespace lobelia::app
