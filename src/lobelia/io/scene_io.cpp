// Which reader reads a scene file: decided by its extension.

#include "lobelia/io/scene_io.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace lobelia::io {

Scene readScene(const std::string& file, const ReadSettings& settings, Context& context) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".xml") return readMitsuba(file, settings, context);
  throw InputError({file, 0, 0}, "no reader knows the extension '" + extension +
                                     "'; scenes that can be read: .xml (Mitsuba 0.5 to 3)");
}

}  // namespace lobelia::io
