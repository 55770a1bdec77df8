// What is wrong with a file that a scene names is told with the place where it is named, too.
#pragma once

#include <string>

#include "lobelia/base/error.h"

namespace lobelia::io::mitsuba {

// read(), whose InputErrors get `where` in front, if they do not begin with it already.
template <class Read>
auto readAt(const Location& where, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (where.file.empty() || message.starts_with(toString(where))) throw;
    throw InputError(where, message);
  }
}

}  // namespace lobelia::io::mitsuba
