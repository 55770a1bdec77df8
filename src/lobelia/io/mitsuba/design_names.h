// What designs call things that have no name of their own (internal to io).
#pragma once

#include <string>

#include "lobelia/io/design.h"

namespace lobelia::io::mitsuba {

std::string placeName(const char* kind, size_t index);  // "material[7]"

}  // namespace lobelia::io::mitsuba
