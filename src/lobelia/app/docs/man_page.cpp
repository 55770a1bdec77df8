// Man pages, in the macros of man(7).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "lobelia/app/docs/command_texts.h"
#include "lobelia/app/docs/writers.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

// Dashes that are typed, backslashes, and a dot or quote that would make a line a request.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string paragraphs(const std::string& text) {
  std::string out = escaped(text) + "\n";
  for (size_t at = 0; (at = out.find("\n\n", at)) != std::string::npos;)
    out.replace(at, 2, "\n.PP\n");
  return out;
}

std::string item(const std::string& heading, const std::string& text) {
  return fmt::format(".TP\n{}\n{}\n", heading, escaped(text));
}

std::string optionItem(const OptionDoc& option) {
  std::string heading;
  for (const std::string& name : option.names)
    heading += fmt::format("{}\\fB{}\\fR", heading.empty() ? "" : ", ", escaped(name));
  if (option.names.empty()) heading = fmt::format("\\fI{}\\fR", escaped(option.argument));
  if (!option.type.empty() && !option.names.empty())
    heading += fmt::format(" \\fI{}\\fR", escaped(option.type));
  std::string text = option.description + ".";
  if (!option.choices.empty()) text += fmt::format(" One of: {}.", fmt::join(option.choices, ", "));
  if (option.takes("LIST")) text.replace(text.find(" One of:"), 8, " Any of:");
  if (!option.defaultValue.empty()) text += fmt::format(" Default: {}.", option.defaultValue);
  if (option.repeatable) text += " May be repeated.";
  if (option.required) text += " Required.";
  return item(heading, text);
}

std::string titled(const std::string& title, const std::string& body) {
  return body.empty() ? "" : fmt::format(".SH {}\n{}", title, body);
}

std::string items(const std::vector<NamedText>& texts) {
  std::string out;
  for (const NamedText& text : texts) out += item("\\fB" + escaped(text.name) + "\\fR", text.text);
  return out;
}

}  // namespace

std::string manPageName(const ProgramDoc& doc, const CommandDoc& command) {
  return &command == &doc.program ? "lobelia" : "lobelia-" + command.name;
}

std::string manPage(const ProgramDoc& doc, const CommandDoc& command) {
  const bool program = &command == &doc.program;
  const CommandTexts& texts = commandTexts(program ? "" : command.name);
  const std::string name = manPageName(doc, command);
  std::string upper = name, options, commands, examples, others;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const OptionDoc& argument : command.arguments) options += optionItem(argument);
  for (const OptionDoc& option : command.options) options += optionItem(option);
  if (!program) others = ".BR lobelia (1)";
  for (const CommandDoc& other : doc.commands) {
    if (program)
      commands += item(fmt::format("\\fB{}\\fR", escaped(other.name)), other.summary + ".");
    if (&other != &command)
      others += fmt::format("{}.BR {} (1)", others.empty() ? "" : ",\n",
                            escaped(manPageName(doc, other)));
  }
  for (const NamedText& example : texts.examples) {
    examples += fmt::format(".PP\n{}:\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", escaped(example.text),
                            escaped(example.name));
  }
  const std::string usage = program ? "lobelia COMMAND [ARGUMENT]..." : synopsis(command);
  return fmt::format(
             ".\\\" Written by `lobelia docs man`; do not edit.\n"
             ".TH {} 1 \"\" \"lobelia {}\" \"Lobelia\"\n",
             escaped(upper), kVersion) +
         titled("NAME", fmt::format("{} \\- {}\n", escaped(name), escaped(command.summary))) +
         titled("SYNOPSIS", fmt::format(".nf\n{}\n.fi\n", escaped(usage))) +
         titled("DESCRIPTION", paragraphs(texts.description)) + titled("COMMANDS", commands) +
         titled("OPTIONS", options) + titled("EXIT STATUS", items(exitCodeTexts())) +
         titled("FILES", items(texts.files)) + titled("EXAMPLES", examples) +
         titled("SEE ALSO", others + "\n");
}

}  // namespace lobelia::app
