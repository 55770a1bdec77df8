// What the writers of shell completion share.
#pragma once

#include <string>
#include <vector>

#include "lobelia/app/docs/command_docs.h"

namespace lobelia::app {

std::vector<std::string> commandNames(const ProgramDoc& doc);
// A word in single quotes for bash and zsh: a quote inside becomes '\''.
std::string shellQuoted(const std::string& text);
// The first sentence or clause of a description, short enough for a menu.
std::string menuText(const std::string& description);

}  // namespace lobelia::app
