// Files packed with gzip (RFC 1952).
#pragma once

#include <string>

#include "lobelia/base/error.h"

namespace lobelia::io {

bool isGzip(const std::string& bytes);
// The contents; throws InputError at `where` when they are damaged, end early, or are larger than
// maxBytes.
std::string gunzip(const std::string& bytes, const Location& where,
                   uint64_t maxBytes = uint64_t{1} << 34);

}  // namespace lobelia::io
