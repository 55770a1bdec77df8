// The window's life: input, a frame of panels, what the engine has drawn since, and again; asleep
// while nothing happens. It never waits for rendering.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/app/view.h"
#include "lobelia/app/viewer/window/surface.h"
#include "lobelia/app/viewer/window/ui.h"
#include "lobelia/app/viewer/window/ui_player.h"

namespace lobelia::app {

class Viewer {
 public:
  // Throws InputError of the UI script.
  Viewer(const ViewOptions& options, Studio& studio, Surface& surface, Context& context);

  // Until the window is closed, the UI script is played or the context is cancelled. Throws what
  // the script (UiPlayer::play()) and a window that cannot be made anew throw.
  void run();

 private:
  void frame();
  void pause();
  void recover();
  bool inputCame();
  void arrived();
  bool showNewest();
  UiStage stage();
  void act(const UiStep& step);

  Context& context_;
  Surface& surface_;
  Studio& studio_;
  Ui ui_;
  std::optional<UiPlayer> player_;
  std::string screenshot_;  // of the next frame, to this file
};

}  // namespace lobelia::app
