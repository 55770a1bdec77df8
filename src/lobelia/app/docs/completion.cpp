#include "lobelia/app/docs/completion.h"

namespace lobelia::app {

std::vector<std::string> commandNames(const ProgramDoc& doc) {
  std::vector<std::string> names;
  for (const CommandDoc& command : doc.commands) names.push_back(command.name);
  return names;
}

std::string shellQuoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string menuText(const std::string& description) {
  constexpr size_t kLongest = 70;
  const size_t end = description.find("; ");
  std::string text = description.substr(0, end);
  if (text.size() <= kLongest) return text;
  return text.substr(0, text.rfind(' ', kLongest)) + " ...";
}

}  // namespace lobelia::app
