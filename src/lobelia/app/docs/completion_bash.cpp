// Completion for bash, with nothing but its builtins (the package bash-completion is not needed).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lobelia/app/docs/completion.h"
#include "lobelia/app/docs/writers.h"
#include "lobelia/builtin/builtin_scenes.h"

namespace lobelia::app {
namespace {

constexpr const char* kHelpers = R"(
_lobelia_words() { mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$1" -- "$cur"); }
_lobelia_files() {
  compopt -o filenames 2> /dev/null
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen "$1" -- "$cur")
}
_lobelia_list() {
  local before=
  [[ $cur == *,* ]] && before=${cur%,*},
  compopt -o nospace 2> /dev/null
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${cur##*,}")
}
)";

// The statements that complete the value of an option or argument.
std::string completeValue(const OptionDoc& option) {
  std::string out;
  const std::string choices = fmt::format("'{}'", fmt::join(option.choices, " "));
  if (option.takes("LIST")) return fmt::format("_lobelia_list {}; ", choices);
  if (!option.choices.empty()) out += fmt::format("_lobelia_words {}; ", choices);
  if (option.takes("SCENE")) out += "_lobelia_words \"$scenes\"; ";
  if (option.takes("FILE")) out += "_lobelia_files -f; ";
  if (option.takes("FOLDER")) out += "_lobelia_files -d; ";
  return out;
}

std::string optionNames(const CommandDoc& command) {
  std::string out;
  for (const OptionDoc& option : command.options)
    out += fmt::format("{}{}", out.empty() ? "" : " ", fmt::join(option.names, " "));
  return out;
}

}  // namespace

std::string bashCompletion(const ProgramDoc& doc) {
  std::string values, options, arguments;
  for (const CommandDoc& command : doc.commands) {
    for (const OptionDoc& option : command.options) {
      if (option.type.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) patterns.push_back(command.name + ":" + name);
      values +=
          fmt::format("    {}) {}return ;;\n", fmt::join(patterns, "|"), completeValue(option));
    }
    options +=
        fmt::format("      {}) _lobelia_words '{}' ;;\n", command.name, optionNames(command));
    // A command's arguments are of one kind.
    if (!command.arguments.empty())
      arguments +=
          fmt::format("    {}) {};;\n", command.name, completeValue(command.arguments.front()));
  }
  return fmt::format(
      "# Completion of lobelia for bash. Written by `lobelia completion bash`; do not edit.\n"
      "# shellcheck shell=bash disable=SC2034\n{}\n"
      "_lobelia() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} previous command=${{COMP_WORDS[1]}}\n"
      "  local scenes='{}'\n"
      "  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)); then\n"
      "    _lobelia_words '{} {}'\n"
      "    return\n"
      "  fi\n"
      "  previous=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  # bash splits --option=value into three words.\n"
      "  if [[ $cur == = ]]; then cur=; elif [[ $previous == = ]]; then "
      "previous=${{COMP_WORDS[COMP_CWORD - "
      "2]}}; fi\n"
      "  case $command:$previous in\n{}  esac\n"
      "  if [[ $cur == -* ]]; then\n"
      "    case $command in\n{}    esac\n"
      "    return\n"
      "  fi\n"
      "  case $command in\n{}  esac\n"
      "}}\n"
      "complete -F _lobelia lobelia\n",
      kHelpers, fmt::join(builtin::builtinSceneNames(), " "), fmt::join(commandNames(doc), " "),
      optionNames(doc.program), values, options, arguments);
}

}  // namespace lobelia::app
