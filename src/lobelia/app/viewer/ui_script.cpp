#include "lobelia/app/viewer/ui_script.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>

namespace lobelia::app {
namespace {

using Kind = UiStep::Kind;
using Words = std::vector<std::string>;
constexpr int kMostFrames = 100'000;
constexpr int kLargestSide = 16'384;

template <class T>
T number(const std::string& text, T least, T most, const Location& where) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= least) ||
      !(value <= most))
    throw InputError(where, fmt::format("'{}' is not a number from {} to {}", text, least, most));
  return value;
}

Vec2f place(const std::string& text, const Location& where) {
  const size_t comma = text.find(',');
  if (comma == std::string::npos)
    throw InputError(where, fmt::format("'{}' is no place in the picture, as 0.5,0.25", text));
  return {number(text.substr(0, comma), 0.f, 1.f, where),
          number(text.substr(comma + 1), 0.f, 1.f, where)};
}

Vec2i size(const std::string& text, const Location& where) {
  const size_t x = text.find('x');
  if (x == std::string::npos)
    throw InputError(where, fmt::format("'{}' is no size, as 640x480", text));
  return {number(text.substr(0, x), 0, kLargestSide, where),
          number(text.substr(x + 1), 0, kLargestSide, where)};
}

// Takes shift+, ctrl+ and alt+ off.
std::string unmodified(std::string text, UiStep& step) {
  const std::map<std::string, bool*> modifiers{
      {"shift+", &step.shift}, {"ctrl+", &step.ctrl}, {"alt+", &step.alt}};
  for (bool again = true; again;) {
    again = false;
    for (const auto& [prefix, flag] : modifiers)
      if (text.size() > prefix.size() && text.starts_with(prefix)) {
        text.erase(0, prefix.size());
        *flag = again = true;
      }
  }
  return text;
}

int button(const std::string& text, const Location& where) {
  const std::vector<std::string> names{"left", "right", "middle"};
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return static_cast<int>(i);
  throw InputError(
      where, fmt::format("'{}' is no button of a mouse; there are left, right and middle{}", text,
                         suggestion(text, names)));
}

struct Verb {
  Kind kind;
  size_t values;
  const char* usage;
  std::function<void(UiStep&, const Words&)> fill;
};

std::map<std::string, Verb> makeVerbs() {
  std::map<std::string, Verb> v;
  v["click"] = {Kind::click, 1, "click LABEL", [](UiStep& s, const Words& w) { s.label = w[0]; }};
  v["type"] = {Kind::type, 2, "type LABEL TEXT",
               [](UiStep& s, const Words& w) { s.label = w[0], s.text = w[1]; }};
  v["slide"] = {Kind::slide, 2, "slide LABEL SHARE", [](UiStep& s, const Words& w) {
                  s.label = w[0], s.amount = number(w[1], 0.f, 1.f, s.where);
                }};
  v["click-picture"] = {Kind::clickPicture, 1, "click-picture X,Y",
                        [](UiStep& s, const Words& w) { s.from = place(w[0], s.where); }};
  v["drag-picture"] = {Kind::dragPicture, 3, "drag-picture BUTTON X,Y X,Y",
                       [](UiStep& s, const Words& w) {
                         s.button = button(unmodified(w[0], s), s.where);
                         s.from = place(w[1], s.where), s.to = place(w[2], s.where);
                       }};
  v["wheel"] = {Kind::wheel, 2, "wheel X,Y STEPS", [](UiStep& s, const Words& w) {
                  s.from = place(w[0], s.where);
                  s.amount = number(w[1], -100.f, 100.f, s.where);
                }};
  v["key"] = {Kind::key, 1, "key NAME",
              [](UiStep& s, const Words& w) { s.text = unmodified(w[0], s); }};
  v["drop"] = {Kind::drop, 1, "drop FILE", [](UiStep& s, const Words& w) {
                 s.text = (std::filesystem::path(s.where.file).parent_path() / w[0]).string();
               }};
  v["wait"] = {Kind::wait, 0, "wait", [](UiStep&, const Words&) {}};
  v["frames"] = {Kind::frames, 1, "frames N", [](UiStep& s, const Words& w) {
                   s.count = number(w[0], 1, kMostFrames, s.where);
                 }};
  v["ui-screenshot"] = {Kind::screenshot, 1, "ui-screenshot FILE.png",
                        [](UiStep& s, const Words& w) {
                          s.text = w[0];
                          if (!s.text.ends_with(".png"))
                            throw InputError(s.where, "pictures of the window are .png");
                        }};
  v["resize"] = {Kind::resize, 1, "resize WxH",
                 [](UiStep& s, const Words& w) { s.size = size(w[0], s.where); }};
  v["minimise"] = {Kind::minimise, 0, "minimise", [](UiStep&, const Words&) {}};
  v["restore"] = {Kind::restore, 0, "restore", [](UiStep&, const Words&) {}};
  v["lose-context"] = {Kind::loseContext, 0, "lose-context", [](UiStep&, const Words&) {}};
  v["expect"] = {Kind::expect, 1, "expect TEXT", [](UiStep& s, const Words& w) { s.text = w[0]; }};
  return v;
}

// Words between blanks; "..." is one word. A # that begins a word ends the line.
Words wordsOf(const std::string& line, const Location& where) {
  Words words;
  for (size_t at = 0; at < line.size();) {
    if (line[at] == ' ' || line[at] == '\t' || line[at] == '\r') {
      ++at;
      continue;
    }
    if (line[at] == '#') break;
    if (line[at] == '"') {
      const size_t end = line.find('"', at + 1);
      if (end == std::string::npos) throw InputError(where, "a \" without its second");
      words.push_back(line.substr(at + 1, end - at - 1));
      at = end + 1;
    } else {
      const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
      words.push_back(line.substr(at, end - at));
      at = end;
    }
  }
  return words;
}

UiStep stepOf(Words words, const Location& where) {
  static const std::map<std::string, Verb> verbs = makeVerbs();
  const auto verb = verbs.find(words.front());
  if (verb == verbs.end()) {
    Words known;
    for (const auto& [name, ignored] : verbs) known.push_back(name);
    throw InputError(where, fmt::format("unknown command '{}'{}", words.front(),
                                        suggestion(words.front(), known)));
  }
  words.erase(words.begin());
  if (words.size() != verb->second.values)
    throw InputError(where, fmt::format("what is right here is: {}", verb->second.usage));
  UiStep step;
  step.kind = verb->second.kind;
  step.where = where;
  verb->second.fill(step, words);
  return step;
}

}  // namespace

std::vector<UiStep> readUiScript(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw InputError({file}, "there is no such file");
  std::ifstream in(file);
  if (!in) throw InputError({file}, "cannot be read as a script");
  std::vector<UiStep> steps;
  std::string line;
  for (int row = 1; std::getline(in, line); ++row) {
    const Location where{file, row, 0};
    Words words = wordsOf(line, where);
    if (!words.empty()) steps.push_back(stepOf(std::move(words), where));
  }
  return steps;
}

}  // namespace lobelia::app
