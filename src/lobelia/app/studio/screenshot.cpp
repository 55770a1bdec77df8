#include "lobelia/app/studio/screenshot.h"

#include <fmt/format.h>

#include <filesystem>

#include "lobelia/base/error.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {

void writeScreenshot(const std::string& file, const Picture& picture, const Picture* truth,
                     const DisplaySettings& settings) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".exr") return io::writeExr(file, picture.film);
  if (extension != ".png")
    throw UsageError(fmt::format("'{}': screenshots are written as .exr or .png", file));
  const Displayed shown = displayPicture(picture, truth, settings);
  std::vector<uint8_t> rgb;
  rgb.reserve(shown.pixels.size() / 4 * 3);
  for (size_t i = 0; i < shown.pixels.size(); ++i)
    if (i % 4 != 3) rgb.push_back(shown.pixels[i]);
  io::writePng(file, rgb, shown.width, shown.height);
}

}  // namespace lobelia::app
