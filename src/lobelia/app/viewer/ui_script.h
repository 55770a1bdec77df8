// Scripts of `lobelia view --ui-script FILE`: what a hand does at the window, one thing a line.
//
//   click LABEL                     a widget by its label ("a b" with blanks; PANEL/LABEL where
//                                   several panels have it)
//   type LABEL TEXT                 into a field or a slider, with Enter
//   slide LABEL SHARE               drag a slider to a share of its width, 0 to 1
//   click-picture X,Y               places in the picture are shares of it, 0,0 its top left
//   drag-picture BUTTON X,Y X,Y     BUTTON: left, right, middle, with shift+, ctrl+ or alt+ before
//   wheel X,Y STEPS                 up: positive
//   key NAME                        a letter, a digit, F1 ... F12, Tab, Enter, Escape, Delete,
//                                   Backspace, Space, Home, Left, Right, Up, Down; with shift+,
//                                   ctrl+ or alt+ before
//   drop FILE                       a file from the desktop
//   wait                            until the engine has drawn what was asked for
//   frames N                        so many frames of the window
//   ui-screenshot FILE.png          the window as it is
//   resize WxH, minimise, restore   the window
//   lose-context                    as if the graphics driver had been reset
//   expect TEXT                     fails unless a note or the status line has this text
//
// Empty lines and what follows a # at the beginning or after a blank mean nothing. The window
// closes after the last line. Files are sought from the script's folder, screenshots from where one
// stands.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/error.h"
#include "lobelia/base/vec.h"

namespace lobelia::app {

struct UiStep {
  enum class Kind : uint8_t {
    click,
    type,
    slide,
    clickPicture,
    dragPicture,
    wheel,
    key,
    drop,
    wait,
    frames,
    screenshot,
    resize,
    minimise,
    restore,
    loseContext,
    expect
  };
  Kind kind = Kind::wait;
  Location where;
  std::string label;  // click, type, slide
  std::string text;   // type, expect; drop, screenshot: the file; key: its name
  Vec2f from, to;     // shares of the picture
  float amount = 0;   // slide: share; wheel: steps
  int count = 1;      // frames
  Vec2i size;         // resize
  int button = 0;     // 0 left, 1 right, 2 middle
  bool shift = false, ctrl = false, alt = false;
};

// Throws InputError with the line.
std::vector<UiStep> readUiScript(const std::string& file);

}  // namespace lobelia::app
