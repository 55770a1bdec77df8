// Labelled widgets of the panels: the label on the left, the value on the right, its place noted
// for scripts (marks.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobelia/app/viewer/window/marks.h"
#include "lobelia/base/vec.h"

namespace lobelia::app {

// What a person did to a value in this frame.
struct Touch {
  bool changed = false;  // it has another value
  bool done = false;     // let go: the next change is another step of undo
  explicit operator bool() const { return changed; }
};

class Widgets {
 public:
  explicit Widgets(Marks& marks) : marks_(marks) {}

  bool button(const std::string& label, bool enabled = true, float width = 0);
  // A button in the place of a value.
  bool withLabel(const std::string& label, const std::string& text);
  Touch checkBox(const std::string& label, bool& value);
  // format: printf's for one float.
  Touch slider(const std::string& label, float& value, float least, float most,
               bool logarithmic = false, const char* format = "%.3g");
  Touch slider(const std::string& label, int& value, int least, int most, bool logarithmic = false);
  // No limits but these; drags by a share of the value.
  Touch number(const std::string& label, float& value, float least, float most);
  Touch numbers(const std::string& label, Vec3f& value, float speed);
  // Scene-linear; the swatch and its picker show it as a screen does (sRGB). What may be more than
  // 1 has numbers alone.
  Touch color(const std::string& label, Rgb& value, float most);
  // done: Enter was pressed.
  Touch text(const std::string& label, std::string& value, const char* hint = "");
  Touch choice(const std::string& label, int& value, std::span<const char* const> names);
  // One row of a list.
  bool row(const std::string& label, bool chosen);
  bool section(const char* label, bool open = true);
  // Explains the widget drawn last to whoever stays on it.
  void hint(const std::string& text);
  void quiet(const std::string& text);  // grey, wrapped
  // So much is left free at the right of the next values, for a button beside them.
  void leave(float width) { left_ = width; }
  Marks& marks() { return marks_; }

 private:
  // Draws the label; the value's widget comes next. Returns its hidden label.
  std::string name(const std::string& label);
  Touch touched(const std::string& label, bool changed);
  Marks& marks_;
  float left_ = 0;
};

// The part of a label that people read (before "##").
std::string shownLabel(const std::string& label);

}  // namespace lobelia::app
