// Where tests find real scenes and reference images that are not part of the project.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lobelia::test {

// LOBELIA_DATA when set, else ../shared beside the repository; empty when there is none. Tests that
// need it skip then.
inline std::string sharedFolder() {
  if (const char* folder = std::getenv("LOBELIA_DATA")) return folder;
  const std::filesystem::path beside = std::filesystem::path(LOBELIA_SOURCE_DIR) / ".." / "shared";
  return std::filesystem::is_directory(beside) ? beside.lexically_normal().string() : "";
}

}  // namespace lobelia::test
