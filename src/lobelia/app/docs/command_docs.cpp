#include "lobelia/app/docs/command_docs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

namespace lobelia::app {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  size_t begin = 0;
  while (begin <= text.size()) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// get_type_name() is the type, and behind colons what validators say of themselves.
void readType(const CLI::Option& option, OptionDoc& doc) {
  const std::string text = option.get_type_name();
  const size_t begin = text.find(":{"), end = text.find('}');
  doc.type = text.substr(0, begin);
  if (begin != std::string::npos && end != std::string::npos)
    doc.choices = split(text.substr(begin + 2, end - begin - 2), ',');
}

OptionDoc describe(const CLI::Option& option) {
  OptionDoc doc;
  for (const std::string& name : option.get_snames()) doc.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) doc.names.push_back("--" + name);
  if (doc.names.empty()) doc.argument = option.get_name(true);
  doc.description = option.get_description();
  doc.required = option.get_required();
  if (option.get_items_expected_max() == 0) return doc;
  readType(option, doc);
  doc.defaultValue = option.get_default_str();
  doc.repeatable = option.get_items_expected_max() > 1;
  return doc;
}

CommandDoc describeCommand(const CLI::App& app) {
  CommandDoc doc{app.get_name(), app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    OptionDoc described = describe(*option);
    (described.names.empty() ? doc.arguments : doc.options).push_back(std::move(described));
  }
  return doc;
}

}  // namespace

bool OptionDoc::takes(const std::string& kind) const {
  const std::vector<std::string> kinds = split(type, '|');
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

ProgramDoc describe(const CLI::App& app) {
  ProgramDoc doc{describeCommand(app), {}};
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_group().empty()) doc.commands.push_back(describeCommand(*command));
  return doc;
}

std::string synopsis(const CommandDoc& command) {
  std::string out = fmt::format("lobelia {}", command.name);
  for (const OptionDoc& argument : command.arguments) {
    std::string name = argument.argument;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    out += argument.required ? " " + name : fmt::format(" [{}]", name);
  }
  for (const OptionDoc& option : command.options)
    if (option.required) out += fmt::format(" {} {}", option.names.front(), option.type);
  return out + " [OPTION]...";
}

std::string heading(const OptionDoc& option) {
  if (option.names.empty()) return option.argument;
  return fmt::format("{}{}{}", fmt::join(option.names, ", "), option.type.empty() ? "" : " ",
                     option.type);
}

}  // namespace lobelia::app
