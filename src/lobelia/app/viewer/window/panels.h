// The panels, each drawn into the Dear ImGui window that is begun. What they change goes to the
// engine as edits or into UiState::view and ::display.
#pragma once

#include "lobelia/app/viewer/window/ui_state.h"

namespace lobelia::app {

void drawHistoryPanel(UiState& ui);   // undo, redo
void drawMaterialPanel(UiState& ui);  // list, type, fields, textures, bump
void drawLightPanel(UiState& ui);     // environment, rotation, exposure, emitters
void drawMethodPanel(UiState& ui);    // method and settings
void drawDisplayPanel(UiState& ui);   // false colours, split view
// Frame rate, passes, error, time split. Its height changes with every method: nothing goes below.
void drawTimePanel(UiState& ui);
void drawCameraPanel(UiState& ui);
void drawFilesPanel(UiState& ui);  // designs, screenshots

// "sglc: converging, 37 of 256 samples".
std::string statusText(const UiState& ui);

}  // namespace lobelia::app
