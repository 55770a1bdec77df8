#include "lobelia/app/viewer/window/ui_player.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <map>

#include "lobelia/base/context.h"

namespace lobelia::app {
namespace {

constexpr int kFramesToFind = 30;  // a panel may be scrolled first
constexpr int kDragSteps = 8;
constexpr Vec2f kAway{-1, -1};  // outside of the window
constexpr int kQuietFrames = 4;

}  // namespace

std::optional<int> keyOf(const std::string& name) {
  static const std::map<std::string, int> named{{"Tab", GLFW_KEY_TAB},
                                                {"Enter", GLFW_KEY_ENTER},
                                                {"Escape", GLFW_KEY_ESCAPE},
                                                {"Delete", GLFW_KEY_DELETE},
                                                {"Space", GLFW_KEY_SPACE},
                                                {"Left", GLFW_KEY_LEFT},
                                                {"Right", GLFW_KEY_RIGHT},
                                                {"Up", GLFW_KEY_UP},
                                                {"Down", GLFW_KEY_DOWN},
                                                {"Home", GLFW_KEY_HOME},
                                                {"Backspace", GLFW_KEY_BACKSPACE}};
  if (const auto found = named.find(name); found != named.end()) return found->second;
  if (name.size() == 1) {
    const char c = name[0];
    if (c >= 'a' && c <= 'z') return GLFW_KEY_A + (c - 'a');
    if (c >= 'A' && c <= 'Z') return GLFW_KEY_A + (c - 'A');
    if (c >= '0' && c <= '9') return GLFW_KEY_0 + (c - '0');
  }
  for (int i = 1; i <= 12; ++i)
    if (name == fmt::format("F{}", i)) return GLFW_KEY_F1 + i - 1;
  return std::nullopt;
}

UiPlayer::UiPlayer(std::vector<UiStep> steps, UiStage stage)
    : steps_(std::move(steps)), stage_(std::move(stage)) {}

Vec2f UiPlayer::inPicture(Vec2f share) const {
  const MarkedBox box = stage_.picture();
  return {box.lo.x + share.x * (box.hi.x - box.lo.x), box.lo.y + share.y * (box.hi.y - box.lo.y)};
}

// The first frame says where the picture is.
bool UiPlayer::laidOut() const {
  const MarkedBox box = stage_.picture();
  return box.hi.x > box.lo.x && box.hi.y > box.lo.y;
}

// Moves are taken from the end.
void UiPlayer::press(Vec2f at, int button, const UiStep& s) {
  const Move move{.to = at, .ctrl = s.ctrl, .shift = s.shift, .alt = s.alt};
  Move down = move, up = move;
  down.button = up.button = button;
  down.down = true;
  moves_ = {move, up, move, down, move, move};
}

void UiPlayer::dragTo(Vec2f from, Vec2f to, int button, const UiStep& s) {
  const Move at{.to = from, .ctrl = s.ctrl, .shift = s.shift, .alt = s.alt};
  Move down = at, up = at;
  down.button = up.button = button;
  down.down = true;
  up.to = to;
  moves_ = {up};
  for (int i = kDragSteps; i >= 1; --i) {
    Move move = at;
    const float t = static_cast<float>(i) / kDragSteps;
    move.to = Vec2f(from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t);
    moves_.push_back(move);
  }
  moves_.push_back(down);
  moves_.push_back(at);
}

void UiPlayer::tap(int key, const UiStep& s) {
  const Move held{.ctrl = s.ctrl, .shift = s.shift, .alt = s.alt};
  Move down = held;
  down.key = key;
  moves_.insert(moves_.begin(), {Move{}, held, down, held});
}

// The widget of a step when it is in sight; empty: ask again with the next frame.
std::optional<MarkedBox> UiPlayer::reach(const UiStep& step) {
  const std::optional<MarkedBox> box = stage_.marks.find(step.label);
  // Scrolling shows with the frame after; what still moves would be missed.
  const bool still = box && *box == lastBox_;
  lastBox_ = box.value_or(MarkedBox());
  if (still && box->visible && sought_ >= 2) {
    sought_ = 0;
    stage_.seek("");
    return box;
  }
  stage_.seek(step.label);
  if (++sought_ > kFramesToFind) {
    const std::vector<std::string> labels = stage_.marks.labels();
    throw InputError(step.where,
                     fmt::format("the window has no '{}'{}; there are {}", step.label,
                                 suggestion(step.label, labels), fmt::join(labels, ", ")));
  }
  return std::nullopt;
}

// False: the step is not done yet, and wants another frame.
bool UiPlayer::begin(const UiStep& step) {
  using Kind = UiStep::Kind;
  switch (step.kind) {
    case Kind::click:
    case Kind::type:
    case Kind::slide: {
      const std::optional<MarkedBox> box = reach(step);
      if (!box) return false;
      const Vec2f middle{(box->lo.x + box->hi.x) / 2, (box->lo.y + box->hi.y) / 2};
      if (step.kind == Kind::slide) {
        const float inset = ImGui::GetStyle().GrabMinSize / 2 + 2;
        const float x = box->lo.x + inset + step.amount * (box->hi.x - box->lo.x - 2 * inset);
        dragTo(middle, {x, middle.y}, 0, step);
      } else if (step.kind == Kind::click) {
        press(middle, 0, step);
      } else {
        UiStep ctrl;
        ctrl.ctrl = true;
        press(middle, 0, ctrl);  // turns a slider into a field
        tap(GLFW_KEY_A, ctrl);
        moves_.insert(moves_.begin(), Move{.characters = step.text});
        tap(GLFW_KEY_ENTER, {});
      }
      moves_.insert(moves_.begin(), Move{.to = kAway});  // hints would cover what is beside it
      return true;
    }
    case Kind::clickPicture:
      if (!laidOut()) return false;
      press(inPicture(step.from), 0, step);
      return true;
    case Kind::dragPicture:
      if (!laidOut()) return false;
      dragTo(inPicture(step.from), inPicture(step.to), step.button, step);
      return true;
    case Kind::wheel: {
      if (!laidOut()) return false;
      const Vec2f at = inPicture(step.from);
      moves_ = {{.to = at}, {.to = at, .wheel = step.amount}, {.to = at}, {.to = at}};
      return true;
    }
    case Kind::key: {
      const std::optional<int> key = keyOf(step.text);
      if (!key) throw InputError(step.where, fmt::format("there is no key '{}'", step.text));
      tap(*key, step);
      return true;
    }
    case Kind::wait:
      if (waitingSince_ == 0) waitingSince_ = nanosecondsNow();
      if (static_cast<double>(nanosecondsNow() - waitingSince_) * 1e-9 > kPatience)
        throw RuntimeError(
            fmt::format("{}: nothing was drawn for {} s", toString(step.where), kPatience));
      // What a job has read, and what an edit asks for, shows some frames later.
      sought_ = stage_.drawn() ? sought_ + 1 : 0;
      if (sought_ < kQuietFrames) return false;
      sought_ = 0;
      waitingSince_ = 0;
      return true;
    case Kind::frames:
      if (framesLeft_ == 0) framesLeft_ = step.count + 1;
      return --framesLeft_ == 0;
    case Kind::expect:
      if (!stage_.says(step.text)) {
        if (++sought_ < kFramesToFind) return false;
        throw InputError(step.where, fmt::format("the window does not say '{}'", step.text));
      }
      sought_ = 0;
      return true;
    default:
      stage_.act(step);
      return true;
  }
}

void UiPlayer::apply(const Move& move, ImGuiIO& io) {
  if (move.to) mouse_ = *move.to;
  if (move.button >= 0) down_[move.button] = move.down;
  if (move.key >= 0) io.KeysDown[move.key] = true;
  io.KeyCtrl = move.ctrl, io.KeyShift = move.shift, io.KeyAlt = move.alt;
  io.MouseWheel += move.wheel;
  if (!move.characters.empty()) io.AddInputCharactersUTF8(move.characters.c_str());
}

void UiPlayer::play(ImGuiIO& io) {
  std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
  io.KeyCtrl = io.KeyShift = io.KeyAlt = false;
  if (moves_.empty() && next_ < steps_.size() && begin(steps_[next_])) ++next_;
  if (!moves_.empty()) {
    apply(moves_.back(), io);
    moves_.pop_back();
  }
  io.MousePos = ImVec2(mouse_.x, mouse_.y);
  std::copy(std::begin(down_), std::end(down_), io.MouseDown);
}

}  // namespace lobelia::app
