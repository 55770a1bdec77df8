// What the program has to say while the window is open: it stands over the picture's lower edge
// until it is dismissed; what is no problem goes by itself.
#pragma once

#include <deque>
#include <string>

#include "lobelia/app/viewer/window/marks.h"
#include "lobelia/base/context.h"

namespace lobelia::app {

class Notes {
 public:
  static constexpr size_t kMostKept = 100;
  static constexpr size_t kMostShown = 4;
  static constexpr double kSeconds = 8;  // of what is no problem

  void add(Severity severity, const std::string& text);
  // Within the box (units of Dear ImGui), from below.
  void draw(const MarkedBox& box, Marks& marks);
  bool says(const std::string& text) const;
  // Will something vanish by itself?
  bool passing() const;
  size_t count() const { return notes_.size(); }

 private:
  struct Note {
    Severity severity;
    std::string text;
    int64_t since;
    int times = 1;
    int number;
  };
  bool drawOne(const Note& note, float width, Marks& marks) const;
  void forgetOld();
  std::deque<Note> notes_;
  int nextNumber_ = 0;
};

}  // namespace lobelia::app
