// All that is drawn in a frame of the window, by Dear ImGui alone: panels at both sides, the
// picture between them, notes, keys. Needs a context of Dear ImGui, no window.
#pragma once

#include "lobelia/app/viewer/window/picture_area.h"
#include "lobelia/app/viewer/window/ui_state.h"

namespace lobelia::app {

class Ui {
 public:
  Ui(Studio& studio, const Camera& first) : state_(studio, first) {}

  // Between ImGui::NewFrame() and Render(). pixelScale: framebuffer pixels to a unit of Dear ImGui;
  // largest: pixels of a picture's side at most.
  void draw(const PictureShown& picture, float pixelScale, int largest);
  // Where the picture lies, of the frame before.
  const MarkedBox& pictureBox() const { return box_; }
  UiState& state() { return state_; }

 private:
  void handleKeys();
  void layOut();
  void drawSide(const char* name, float x, float width, bool left);
  void drawStatus();
  void wantPicture(float pixelScale, int largest);

  UiState state_;
  PictureArea area_;
  MarkedBox box_;
};

}  // namespace lobelia::app
