// Completion for fish: one `complete` line per option.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lobelia/app/docs/completion.h"
#include "lobelia/app/docs/writers.h"
#include "lobelia/builtin/builtin_scenes.h"

namespace lobelia::app {
namespace {

std::string fishQuoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

// -x: a value and no files; -r -F: a value that may be a file; -a: what it may be.
std::string valueArguments(const OptionDoc& option) {
  std::vector<std::string> words = option.choices;
  if (option.takes("SCENE") && words.empty()) words = builtin::builtinSceneNames();
  std::string out = option.takes("FILE") || option.takes("FOLDER") ? "-r -F" : "-x";
  if (option.takes("FOLDER")) out = "-x -a '(__fish_complete_directories)'";
  if (option.takes("LIST"))
    return fmt::format("-x -a {}",
                       fishQuoted(fmt::format("(__fish_append , {})", fmt::join(words, " "))));
  if (!words.empty())
    out += fmt::format(" -a {}", fishQuoted(fmt::format("{}", fmt::join(words, " "))));
  return out;
}

std::string names(const OptionDoc& option) {
  std::string out;
  for (const std::string& name : option.names)
    out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return out;
}

std::string line(const std::string& condition, const OptionDoc& option) {
  return fmt::format("complete -c lobelia -n {}{}{}{} -d {}\n", fishQuoted(condition),
                     names(option), option.type.empty() ? "" : " ",
                     option.type.empty() ? "" : valueArguments(option),
                     fishQuoted(menuText(option.description)));
}

}  // namespace

std::string fishCompletion(const ProgramDoc& doc) {
  std::string out =
      "# Completion of lobelia for fish. Written by `lobelia completion fish`; do not edit.\n"
      "complete -c lobelia -f\n";
  for (const OptionDoc& option : doc.program.options) out += line("__fish_use_subcommand", option);
  for (const CommandDoc& command : doc.commands) {
    const std::string inside = "__fish_seen_subcommand_from " + command.name;
    out += fmt::format("complete -c lobelia -n __fish_use_subcommand -a {} -d {}\n", command.name,
                       fishQuoted(menuText(command.summary)));
    for (const OptionDoc& option : command.options) out += line(inside, option);
    if (!command.arguments.empty()) out += line(inside, command.arguments.front());
  }
  return out;
}

}  // namespace lobelia::app
