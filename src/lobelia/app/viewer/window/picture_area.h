// The picture between the panels, and what the mouse does on it.
#pragma once

#include <optional>

#include "lobelia/app/viewer/window/ui_state.h"

namespace lobelia::app {

// What is to be drawn: a texture of Dear ImGui (null: nothing yet). Its aspect may be older than
// that of the place it is shown in.
struct PictureShown {
  void* texture = nullptr;
  int width = 0, height = 0;
};

class PictureArea {
 public:
  // box: units of Dear ImGui; pixelScale: framebuffer pixels to one of these.
  void draw(UiState& ui, const PictureShown& picture, const MarkedBox& box, float pixelScale);

 private:
  enum class Drag : uint8_t { none, orbit, pan, dolly, look, rotate, light, split };
  void begin(UiState& ui);
  void drag(UiState& ui);
  void end(UiState& ui);
  void dragCamera(UiState& ui, Vec2f by);
  void dragLight(UiState& ui, Vec2f by);
  void pickAt(UiState& ui, Vec2f at, bool framing);
  void takePicked(UiState& ui);
  void drawLights(UiState& ui);
  void drawSplit(UiState& ui);
  void fly(UiState& ui);
  Vec2f toShare(Vec2f at) const;
  std::optional<Vec2f> toScreen(const UiState& ui, Vec3f point) const;
  int lightAt(const UiState& ui, Vec2f at) const;  // -1: none
  float splitX(const UiState& ui) const;

  MarkedBox box_;
  Drag drag_ = Drag::none;
  bool clicked_ = false;  // pressed and not moved yet
  Vec2f pressedAt_, last_;
  std::optional<Vec2f> framed_;  // the pick whose answer is to be framed
};

}  // namespace lobelia::app
