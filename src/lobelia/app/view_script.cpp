#include "lobelia/app/view_script.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace lobelia::app {
namespace {

using Kind = ScriptStep::Kind;

constexpr int kMostFrames = 1'000'000;

struct Command {
  Kind kind;
  size_t least, most;  // values
  const char* usage;
};
const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> known{
      {"design", {Kind::design, 1, 1, "design FILE"}},
      {"environment", {Kind::environment, 1, 1, "environment FILE"}},
      {"rotate", {Kind::rotate, 1, 1, "rotate DEGREES"}},
      {"turn", {Kind::turn, 1, 1, "turn DEGREES"}},
      {"camera", {Kind::camera, 2, 3, "camera OX,OY,OZ TX,TY,TZ [UX,UY,UZ]"}},
      {"frame", {Kind::frame, 0, 1, "frame [N]"}}};
  return known;
}

template <class T>
std::optional<T> parsed(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

double number(const std::string& text, const Location& where) {
  const std::optional<double> value = parsed<double>(text);
  if (!value || !std::isfinite(*value))
    throw InputError(where, fmt::format("'{}' is not a finite number", text));
  return *value;
}

Vec3d vector(const std::string& text, const Location& where) {
  std::vector<double> values;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) values.push_back(number(part, where));
  if (values.size() != 3)
    throw InputError(where,
                     fmt::format("'{}' is not three numbers with commas, as 0,1.5,-2", text));
  return {values[0], values[1], values[2]};
}

Transform view(const std::vector<std::string>& values, const Location& where) {
  const Vec3d up = values.size() > 2 ? vector(values[2], where) : Vec3d{0, 1, 0};
  const std::optional<Mat4> matrix = lookAt(vector(values[0], where), vector(values[1], where), up);
  if (!matrix)
    throw InputError(where,
                     "the camera has no direction: origin and target must differ, and up "
                     "must not point along it");
  return Transform(*matrix);
}

// Of the line's words but the first.
ScriptStep step(const Command& command, const std::vector<std::string>& values,
                const std::filesystem::path& folder, const Location& where) {
  ScriptStep step;
  step.kind = command.kind, step.where = where;
  switch (command.kind) {
    case Kind::design:
    case Kind::environment:
      step.file = (folder / values[0]).string();
      if (!std::filesystem::is_regular_file(step.file))
        throw InputError(where, fmt::format("there is no file '{}'", step.file));
      break;
    case Kind::rotate:
    case Kind::turn:
      step.degrees = number(values[0], where);
      break;
    case Kind::camera:
      step.toWorld = view(values, where);
      break;
    case Kind::frame:
      if (values.empty()) break;
      const std::optional<int> count = parsed<int>(values[0]);
      if (!count || *count < 1 || *count > kMostFrames)
        throw InputError(where,
                         fmt::format("frame '{}': a number from 1 to {}", values[0], kMostFrames));
      step.count = *count;
      break;
  }
  return step;
}

constexpr const char* kBlanks = " \t\r";

// Without comment (a # at the beginning or after a blank) and blanks around it.
std::string trimmed(std::string line) {
  for (size_t at = line.find('#'); at != std::string::npos; at = line.find('#', at + 1))
    if (at == 0 || std::string_view(kBlanks).find(line[at - 1]) != std::string_view::npos) {
      line.resize(at);
      break;
    }
  const size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string> wordsOf(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

bool namesFile(Kind kind) { return kind == Kind::design || kind == Kind::environment; }

// What may be shown of a word.
std::string shown(const std::string& word) {
  std::string out;
  for (const char c : word.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return out;
}

}  // namespace

std::vector<ScriptStep> readScript(const std::string& file) {
  std::ifstream in(file);
  std::error_code none;
  if (!std::filesystem::exists(file, none)) throw InputError({file}, "there is no such file");
  if (!in || std::filesystem::is_directory(file))
    throw InputError({file}, "cannot be read as a script");
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::vector<ScriptStep> script;
  std::string line;
  for (int row = 1; std::getline(in, line); ++row) {
    line = trimmed(line);
    std::vector<std::string> words = wordsOf(line);
    if (words.empty()) continue;
    const Location where{file, row, 0};
    const auto command = commands().find(words.front());
    if (command == commands().end()) {
      std::vector<std::string> known;
      for (const auto& [name, ignored] : commands()) known.push_back(name);
      throw InputError(where, fmt::format("unknown command '{}'{}; there are camera, design, "
                                          "environment, frame, rotate and turn",
                                          shown(words.front()), suggestion(words.front(), known)));
    }
    // A file's name may have blanks.
    if (namesFile(command->second.kind) && words.size() > 2)
      words = {words.front(), line.substr(line.find_first_not_of(kBlanks, words.front().size()))};
    words.erase(words.begin());
    if (words.size() < command->second.least || words.size() > command->second.most)
      throw InputError(where, fmt::format("what is right here is: {}", command->second.usage));
    script.push_back(step(command->second, words, folder, where));
  }
  const int frames = frameCount(script);
  if (frames == 0) throw InputError({file}, "the script has no frame; add a line: frame");
  if (frames > kMostFrames)
    throw InputError({file}, fmt::format("{} frames are more than {}", frames, kMostFrames));
  return script;
}

int frameCount(const std::vector<ScriptStep>& script) {
  int64_t count = 0;
  for (const ScriptStep& step : script)
    if (step.kind == Kind::frame) count += step.count;
  return static_cast<int>(std::min<int64_t>(count, kMostFrames + 1));
}

}  // namespace lobelia::app
