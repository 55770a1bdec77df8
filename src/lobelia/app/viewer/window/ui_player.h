// Plays a UI script at Dear ImGui's inputs, a bit with every frame of the window, as a hand would:
// it moves, presses, waits a frame and lets go.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/app/viewer/ui_script.h"
#include "lobelia/app/viewer/window/marks.h"

struct ImGuiIO;

namespace lobelia::app {

// What the player asks of the program around it.
struct UiStage {
  const Marks& marks;
  std::function<MarkedBox()> picture;            // where it lies
  std::function<bool()> drawn;                   // has the engine nothing left to draw?
  std::function<bool(const std::string&)> says;  // does a note or the status have this text?
  std::function<void(const std::string&)> seek;  // scroll to this label
  // Kinds that the window does itself: drop, screenshot, resize, minimise, restore, loseContext.
  std::function<void(const UiStep&)> act;
};

class UiPlayer {
 public:
  UiPlayer(std::vector<UiStep> steps, UiStage stage);
  // Before ImGui::NewFrame(): sets mouse and keys. Throws InputError of the line where a label is
  // not to be found or an expectation fails, RuntimeError when a wait takes more than kPatience.
  void play(ImGuiIO& io);
  bool finished() const { return next_ >= steps_.size() && moves_.empty(); }
  static constexpr double kPatience = 600;  // seconds

 private:
  // One frame's worth of input.
  struct Move {
    std::optional<Vec2f> to{};
    int button = -1;  // pressed (down) or let go
    bool down = false;
    int key = -1;
    float wheel = 0;
    std::string characters{};
    bool ctrl = false, shift = false, alt = false;
  };
  bool begin(const UiStep& step);
  void apply(const Move& move, ImGuiIO& io);
  void press(Vec2f at, int button, const UiStep& step);
  void dragTo(Vec2f from, Vec2f to, int button, const UiStep& step);
  void tap(int key, const UiStep& modifiers);
  std::optional<MarkedBox> reach(const UiStep& step);
  Vec2f inPicture(Vec2f share) const;
  bool laidOut() const;

  const std::vector<UiStep> steps_;
  const UiStage stage_;
  size_t next_ = 0;
  std::vector<Move> moves_;  // the last first
  int sought_ = 0;           // frames
  MarkedBox lastBox_;        // of what is sought
  int64_t waitingSince_ = 0;
  int framesLeft_ = 0;
  Vec2f mouse_{-1, -1};
  bool down_[3]{};
};

// Index into ImGuiIO::KeysDown of a key's name; empty: no such key.
std::optional<int> keyOf(const std::string& name);

}  // namespace lobelia::app
