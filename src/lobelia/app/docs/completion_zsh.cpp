// Completion for zsh: one _arguments call per command.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lobelia/app/docs/completion.h"
#include "lobelia/app/docs/writers.h"
#include "lobelia/builtin/builtin_scenes.h"

namespace lobelia::app {
namespace {

// Text within a specification of _arguments, where colons and brackets have a meaning.
std::string specText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string action(const OptionDoc& option) {
  if (option.takes("LIST")) {
    return fmt::format("_values -s , {} {}", option.argument.empty() ? "value" : option.argument,
                       fmt::join(option.choices, " "));
  }
  if (!option.choices.empty()) return fmt::format("({})", fmt::join(option.choices, " "));
  if (option.takes("SCENE") && option.takes("FILE")) return "_lobelia_scenes";
  if (option.takes("SCENE"))
    return fmt::format("({})", fmt::join(builtin::builtinSceneNames(), " "));
  if (option.takes("FILE")) return "_files";
  if (option.takes("FOLDER")) return "_files -/";
  return " ";
}

std::string specification(const OptionDoc& option) {
  if (option.names.empty()) {
    return shellQuoted(fmt::format(":{}:{}", specText(menuText(option.argument)), action(option)));
  }
  std::string value = fmt::format("[{}]", specText(menuText(option.description)));
  if (!option.type.empty()) value += fmt::format(":{}:{}", specText(option.type), action(option));
  const std::string names = fmt::format("{}", fmt::join(option.names, " "));
  const std::string prefix = option.repeatable ? "*" : fmt::format("({})", names);
  if (option.names.size() == 1) return shellQuoted(prefix + names + value);
  return fmt::format("{}{{{}}}{}", shellQuoted(prefix), fmt::join(option.names, ","),
                     shellQuoted(value));
}

}  // namespace

std::string zshCompletion(const ProgramDoc& doc) {
  std::string commands, cases, top;
  for (const CommandDoc& command : doc.commands) {
    commands += fmt::format("        {}\n",
                            shellQuoted(command.name + ":" + specText(menuText(command.summary))));
    std::string specs;
    for (const OptionDoc& option : command.options)
      specs += fmt::format(" \\\n            {}", specification(option));
    for (const OptionDoc& argument : command.arguments)
      specs += fmt::format(" \\\n            {}", specification(argument));
    cases += fmt::format("        {})\n          _arguments{} ;;\n", command.name, specs);
  }
  for (const OptionDoc& option : doc.program.options)
    top += fmt::format(" \\\n    {}", specification(option));
  return fmt::format(
      "#compdef lobelia\n"
      "# Completion of lobelia for zsh. Written by `lobelia completion zsh`; do not edit.\n\n"
      "_lobelia_scenes() {{\n"
      "  _alternative 'scenes:built-in scene:({})' 'files:file:_files'\n"
      "}}\n\n"
      "_lobelia() {{\n"
      "  local context state state_descr line\n"
      "  typeset -A opt_args\n"
      "  _arguments -C{} \\\n    '1:command:->command' '*::argument:->argument'\n"
      "  case $state in\n"
      "    command)\n"
      "      local -a commands=(\n{}      )\n"
      "      _describe command commands ;;\n"
      "    argument)\n"
      "      case $words[1] in\n{}      esac ;;\n"
      "  esac\n"
      "}}\n\n"
      "# Found in the fpath the file is the function; sourced it declares it.\n"
      "if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _lobelia \"$@\"; else compdef _lobelia "
      "lobelia; fi\n",
      fmt::join(builtin::builtinSceneNames(), " "), top, commands, cases);
}

}  // namespace lobelia::app
