#include "lobelia/io/file_bytes.h"

#include <fmt/format.h>

#include <filesystem>

#include "lobelia/base/file.h"

namespace lobelia::io {

std::string readFileBytes(const std::string& file, const std::string& what, const Location& from) {
  const auto fail = [&](const std::string& why) {
    throw InputError(from, fmt::format("cannot read {} file '{}': {}", what, file, why));
  };
  // The system would take such a name for a shorter one.
  if (file.find('\0') != file.npos)
    throw InputError(from, fmt::format("cannot read {} file '{}...': the name has a zero byte",
                                       what, file.c_str()));
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error)) {
    fail("not a regular file");
  }
  try {
    const std::vector<std::byte> bytes = readFile(file);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  } catch (const InputError& e) {  // "FILE: why"
    fail(std::string(e.what()).substr(file.size() + 2));
  }
  return {};
}

void writeFileAtomically(const std::string& file, const std::string& bytes) {
  lobelia::writeFileAtomically(file, std::as_bytes(std::span(bytes)));
}

}  // namespace lobelia::io
