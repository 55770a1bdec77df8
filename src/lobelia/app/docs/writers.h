// The forms in which the command line documents itself.
#pragma once

#include <string>

#include "lobelia/app/docs/command_docs.h"

namespace lobelia::app {

// roff text (man macros); command: one of doc's, or doc.program.
std::string manPage(const ProgramDoc& doc, const CommandDoc& command);
std::string manPageName(const ProgramDoc& doc, const CommandDoc& command);  // "lobelia-render"

std::string optionReference(const ProgramDoc& doc);  // docs/options.md

std::string bashCompletion(const ProgramDoc& doc);
std::string zshCompletion(const ProgramDoc& doc);
std::string fishCompletion(const ProgramDoc& doc);

std::string gallery();  // docs/gallery.md, from the table of built-in scenes

}  // namespace lobelia::app
