// What the panels share: the engine, what is shown of it, and what a person has chosen.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lobelia/app/studio/studio.h"
#include "lobelia/app/viewer/camera_control.h"
#include "lobelia/app/viewer/window/marks.h"
#include "lobelia/app/viewer/window/notes.h"
#include "lobelia/app/viewer/window/widgets.h"

namespace lobelia::app {

struct UiState {
  UiState(Studio& engine, const Camera& first);

  Studio& studio;
  Marks marks;
  Widgets widgets{marks};
  Notes notes;

  // The view that is wanted, given to the engine at the end of every frame. Its camera is
  // control.camera().
  ViewState view;
  CameraControl control;
  Camera firstCamera;        // what "reset" goes back to
  const Design sceneDesign;  // as it was read, for materials that go back to it

  DisplaySettings display;
  bool measureCurve = true;  // the automatic scale, on the next picture
  bool split = false;
  float splitAt = 0.5f;                           // share of the picture's width
  std::shared_ptr<const Picture> picture, truth;  // what is shown
  float legendLeast = 0, legendMost = 0;          // of false colours
  bool showDirty = true;                          // the display is another than what was shown

  uint32_t material = 0;     // chosen
  std::string textureField;  // the word of the field that textures go to
  int emitter = -1;          // chosen; -1: none
  bool panels = true, help = false, smallWhileMoving = true;
  int64_t movedAt = 0;  // when the camera last moved
  bool closing = false;

  std::string materialFilter;
  std::string textureFile, bumpFile, environmentFile, designFile, screenshotFile;
  float bumpScale = 0.01f;

  // `display` with the split, for the picture that is shown.
  DisplaySettings shownDisplay() const;
  // Is the camera being moved?
  bool moving() const;
  void moved();
  // The same for every panel: an edit that a slider may go on with, and its end.
  void edit(const std::string& name, Touch touch, const std::function<void(Design&)>& change);
  // With the camera's own field of view, whatever the window's shape.
  void saveDesign();
  void clampChoices();  // after undo: what is chosen may be gone
};

// Files dropped onto the window: an environment, a texture for the chosen field, a design.
void takeFile(UiState& ui, const std::string& file);

}  // namespace lobelia::app
