// What man pages and docs/options.md say of the program and its commands beyond their options.
#pragma once

#include <string>
#include <vector>

namespace lobelia::app {

struct NamedText {
  std::string name, text;
};

struct CommandTexts {
  std::string description;          // paragraphs, separated by empty lines
  std::vector<NamedText> files;     // files that are read or written
  std::vector<NamedText> examples;  // a command, and what it does
};

// Of a command; of the program for "". Throws std::out_of_range for a command without texts: each
// has to have some.
const CommandTexts& commandTexts(const std::string& command);
const std::vector<NamedText>& exitCodeTexts();
// The examples as --help shows them at its end.
std::string exampleFooter(const std::string& command);

}  // namespace lobelia::app
