// Where the frame's labelled widgets are, so that a script can press them by name.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::app {

// Units of Dear ImGui.
struct MarkedBox {
  Vec2f lo, hi;
  bool visible = false;  // not scrolled out of sight
  friend bool operator==(const MarkedBox&, const MarkedBox&) = default;
};

class Marks {
 public:
  void beginFrame();
  // The panel that the next widgets are in.
  void setPanel(const std::string& name) { panel_ = name; }
  // The widget drawn last. Scrolls it into sight when it is sought.
  void note(const std::string& label);
  // Its label, or PANEL/LABEL where several panels have one. Of this frame or, before its widgets
  // are drawn, of the last.
  std::optional<MarkedBox> find(const std::string& label) const;
  // What note() scrolls to; "": nothing.
  void seek(const std::string& label) { sought_ = label; }
  std::vector<std::string> labels() const;

 private:
  bool is(const std::string& path, const std::string& label) const;
  std::string panel_, sought_;
  std::map<std::string, MarkedBox> now_, before_;  // by PANEL/LABEL
};

}  // namespace lobelia::app
