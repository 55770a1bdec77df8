#include "lobelia/app/view_script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

// What is between the command and its end: how many words, which of them is a file (-1: none; it is
// sought from the script's folder), whether it has to be there.
struct Command {
  Kind kind;
  size_t least, most;
  const char* usage;
  int file = -1;
  bool reads = true;
};
const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> known{
      {"design", {Kind::design, 1, 1, "design FILE", 0}},
      {"environment", {Kind::environment, 1, 1, "environment FILE", 0}},
      {"rotate", {Kind::rotate, 1, 1, "rotate DEGREES"}},
      {"turn", {Kind::turn, 1, 1, "turn DEGREES"}},
      {"camera", {Kind::camera, 2, 3, "camera OX,OY,OZ TX,TY,TZ [UX,UY,UZ]"}},
      {"frame", {Kind::frame, 0, 1, "frame [N]"}},
      {"material", {Kind::material, 3, 3, "material NAME FIELD VALUE"}},
      {"texture", {Kind::texture, 3, 3, "texture NAME FIELD FILE", 2}},
      {"bump", {Kind::bump, 2, 3, "bump NAME FILE [SCALE]", 1}},
      {"normal-map", {Kind::normalMap, 2, 2, "normal-map NAME FILE", 1}},
      {"emitter", {Kind::emitter, 3, 3, "emitter NAME FIELD VALUE"}},
      {"light", {Kind::light, 2, 5, "light add TYPE X,Y,Z R,G,B [NAME], or light remove NAME"}},
      {"undo", {Kind::undo, 0, 0, "undo"}},
      {"redo", {Kind::redo, 0, 0, "redo"}},
      {"save", {Kind::save, 1, 1, "save FILE", 0, false}},
      {"method", {Kind::method, 1, 2, "method NAME [PASSES]"}},
      {"bounce", {Kind::bounce, 1, 1, "bounce N, or bounce all"}},
      {"truth", {Kind::truth, 1, 1, "truth SAMPLES"}},
      {"false-colour", {Kind::falseColour, 1, 3, "false-colour KIND [LEAST MOST]"}},
      {"split", {Kind::split, 1, 1, "split SHARE, or split off"}},
      {"screenshot", {Kind::screenshot, 1, 1, "screenshot FILE", 0, false}}};
  return known;
}

template <class T>
std::optional<T> parsed(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

Transform view(const std::vector<std::string>& values, const Location& where) {
  const Vec3d up = values.size() > 2 ? scriptVector(values[2], where) : Vec3d{0, 1, 0};
  const std::optional<Mat4> matrix =
      lookAt(scriptVector(values[0], where), scriptVector(values[1], where), up);
  if (!matrix)
    throw InputError(where,
                     "the camera has no direction: origin and target must differ, and up "
                     "must not point along it");
  return Transform(*matrix);
}

// -1: all.
int bounceOf(const std::string& text, const Location& where) {
  if (text == "all") return -1;
  const std::optional<int> bounce = parsed<int>(text);
  if (!bounce || *bounce < 0)
    throw InputError(where, fmt::format("bounce '{}': a number from 0, or all", text));
  return *bounce;
}

int countOf(const std::string& text, const char* what, const Location& where) {
  const std::optional<int> count = parsed<int>(text);
  if (!count || *count < 1 || *count > kMostFrames)
    throw InputError(where, fmt::format("{} '{}': a number from 1 to {}", what, text, kMostFrames));
  return *count;
}

// Takes the file out of the words.
void takeFile(const Command& command, const std::filesystem::path& folder, ScriptStep& step) {
  const auto word = step.words.begin() + command.file;
  step.file = (folder / *word).lexically_normal().string();
  step.words.erase(word);
  std::error_code none;
  if (command.reads && !std::filesystem::is_regular_file(step.file, none))
    throw InputError(step.where, fmt::format("there is no file '{}'", step.file));
  const std::filesystem::path parent = std::filesystem::path(step.file).parent_path();
  if (!command.reads && !parent.empty() && !std::filesystem::is_directory(parent, none))
    throw InputError(step.where, fmt::format("there is no folder '{}'", parent.string()));
}

// Of the line's words but the first.
ScriptStep stepOf(const Command& command, const std::vector<std::string>& values,
                  const std::filesystem::path& folder, const Location& where) {
  ScriptStep step;
  step.kind = command.kind, step.where = where, step.words = values;
  if (command.file >= 0) takeFile(command, folder, step);
  switch (step.kind) {
    case Kind::rotate:
    case Kind::turn:
      step.degrees = scriptNumber(values[0], where);
      break;
    case Kind::camera:
      step.toWorld = view(values, where);
      break;
    case Kind::frame:
    case Kind::truth:
      if (!values.empty())
        step.count = countOf(values[0], step.kind == Kind::frame ? "frame" : "truth", where);
      break;
    case Kind::bounce:
      step.count = bounceOf(values[0], where);
      break;
    case Kind::method:
      if (values.size() > 1) step.count = countOf(values[1], "passes", where);
      break;
    default:
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

struct Word {
  std::string text;
  size_t at = 0;  // in the line
};
// Separated by blanks; in double quotes, with what blanks they have.
std::vector<Word> wordsOf(const std::string& line, const Location& where) {
  std::vector<Word> words;
  for (size_t at = 0; (at = line.find_first_not_of(kBlanks, at)) != std::string::npos;) {
    const bool quoted = line[at] == '"';
    if (quoted) ++at;
    const size_t end =
        quoted ? line.find('"', at) : std::min(line.find_first_of(kBlanks, at), line.size());
    if (end == std::string::npos) throw InputError(where, "a quotation mark is not closed");
    words.push_back({line.substr(at, end - at), at});
    at = end + (quoted ? 1 : 0);
  }
  return words;
}

// What may be shown of a word.
std::string shown(const std::string& word) {
  std::string out;
  for (const char c : word.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return out;
}

}  // namespace

double scriptNumber(const std::string& text, const Location& where) {
  const std::optional<double> value = parsed<double>(text);
  if (!value || !std::isfinite(*value))
    throw InputError(where, fmt::format("'{}' is not a finite number", text));
  return *value;
}

Vec3d scriptVector(const std::string& text, const Location& where) {
  std::vector<double> values;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) values.push_back(scriptNumber(part, where));
  if (values.size() != 3)
    throw InputError(where,
                     fmt::format("'{}' is not three numbers with commas, as 0,1.5,-2", text));
  return {values[0], values[1], values[2]};
}

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
    const Location where{file, row, 0};
    std::vector<Word> words = wordsOf(line, where);
    if (words.empty()) continue;
    const std::string& first = words.front().text;
    const auto command = commands().find(first);
    if (command == commands().end()) {
      std::vector<std::string> known;
      for (const auto& [name, ignored] : commands()) known.push_back(name);
      throw InputError(where, fmt::format("unknown command '{}'{}; there are {}", shown(first),
                                          suggestion(first, known), fmt::join(known, ", ")));
    }
    const Command& c = command->second;
    // The name of a file that is the last word may have blanks.
    const size_t last = static_cast<size_t>(c.file + 1);
    if (c.file >= 0 && last == c.most && words.size() > last + 1 && line.back() != '"')
      words[last].text = line.substr(words[last].at), words.resize(last + 1);
    std::vector<std::string> values;
    for (size_t i = 1; i < words.size(); ++i) values.push_back(std::move(words[i].text));
    if (values.size() < c.least || values.size() > c.most)
      throw InputError(where, fmt::format("what is right here is: {}", c.usage));
    script.push_back(stepOf(c, values, folder, where));
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
