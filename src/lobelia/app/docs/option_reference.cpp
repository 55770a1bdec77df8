// docs/options.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lobelia/app/docs/command_texts.h"
#include "lobelia/app/docs/writers.h"

namespace lobelia::app {
namespace {

// Text of a table's cell.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*') out += '\\';
    out += c;
  }
  return out;
}

// Code in a table's cell, in which only the bar needs care.
std::string code(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return fmt::format("`{}`", out);
}

std::string row(const OptionDoc& option) {
  std::string text = cell(option.description);
  if (!option.choices.empty()) {
    text += option.takes("LIST") ? "; any of " : "; one of ";
    for (size_t i = 0; i < option.choices.size(); ++i)
      text += fmt::format("{}{}", i > 0 ? ", " : "", code(option.choices[i]));
  }
  if (option.repeatable) text += "; may be repeated";
  if (option.required) text += "; **required**";
  return fmt::format("| {} | {} | {} |\n", code(heading(option)), text,
                     option.defaultValue.empty() ? "" : code(option.defaultValue));
}

}  // namespace

std::string optionReference(const ProgramDoc& doc) {
  std::string out =
      "# Options\n\n"
      "All commands and options, as `lobelia COMMAND --help` and the man pages have them. Written "
      "by\n"
      "`lobelia docs markdown > docs/options.md`, not by hand. [manual.md](manual.md) says how and "
      "why.\n";
  for (const CommandDoc& command : doc.commands) {
    const CommandTexts& texts = commandTexts(command.name);
    out += fmt::format("\n## {}\n\n{}.\n\n    {}\n\n", command.name, command.summary,
                       synopsis(command));
    out += "| option | meaning | default |\n|---|---|---|\n";
    for (const OptionDoc& argument : command.arguments) out += row(argument);
    for (const OptionDoc& option : command.options) out += row(option);
    for (const NamedText& example : texts.examples)
      out += fmt::format("\n{}:\n\n    {}\n", example.text, example.name);
  }
  out += "\n## Exit codes\n\n| code | meaning |\n|---|---|\n";
  for (const NamedText& exit : exitCodeTexts())
    out += fmt::format("| {} | {} |\n", exit.name, cell(exit.text));
  return out;
}

}  // namespace lobelia::app
