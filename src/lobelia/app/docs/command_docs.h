// What the command line's definition (CLI11) says about itself, as plain data: the one source of
// the man pages, of docs/options.md and of shell completion. What --help has no room for is in
// command_texts.h.
//
// How the definition speaks to completion: an option's type name is FILE, FOLDER, SCENE (a built-in
// one), several of them joined by '|', LIST (of choices, separated by commas), or a placeholder for
// a value that cannot be completed; the choices are a validator's description of the form {a,b}.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace lobelia::app {

struct OptionDoc {
  std::vector<std::string> names;    // with dashes, short ones first; empty: an argument
  std::string argument;              // an argument's name
  std::string type;                  // of the value; empty: a flag
  std::vector<std::string> choices;  // empty: not a closed set
  std::string defaultValue;          // empty: none, or said in the description
  std::string description;
  bool required = false, repeatable = false;

  bool takes(const std::string& kind) const;  // FILE, FOLDER, SCENE, LIST
};

struct CommandDoc {
  std::string name, summary;
  std::vector<OptionDoc> arguments, options;
};

struct ProgramDoc {
  CommandDoc program;                // options before any command
  std::vector<CommandDoc> commands;  // hidden ones are left out
};

ProgramDoc describe(const CLI::App& app);

// "lobelia render SCENE -o FILE [OPTION]..."
std::string synopsis(const CommandDoc& command);
// "-o, --output FILE"
std::string heading(const OptionDoc& option);

}  // namespace lobelia::app
