// Textures and environments: image files to scene-linear pixels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/io/image_io.h"
#include "lobelia/io/image_pixels.h"

namespace lobelia::io {
namespace {

// Which stored channels make the image: (R, G, B[, A]), (grey) or (grey, grey, grey, A).
std::vector<size_t> selectChannels(const StoredImage& stored) {
  const auto find = [&](const char* name) {
    const auto it = std::find(stored.channels.begin(), stored.channels.end(), name);
    return static_cast<size_t>(it - stored.channels.begin());
  };
  const size_t n = stored.channels.size(), alpha = find("A");
  const size_t r = find("R"), g = find("G"), b = find("B");
  if (r < n && g < n && b < n) {
    if (alpha < n) return {r, g, b, alpha};
    return {r, g, b};
  }
  const size_t grey = find("Y") < n ? find("Y") : (alpha == 0 && n > 1 ? 1u : 0u);
  if (alpha < n && alpha != grey) return {grey, grey, grey, alpha};
  return {grey};
}

void decode(Image& image, int integerBits, const ImageOptions& options) {
  const auto channels = static_cast<size_t>(image.channels);
  const auto decodeAll = [&](const auto& ofColor, const auto& ofAlpha) {
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      float& v = image.pixels[i];
      v = i % channels == 3 ? ofAlpha(v) : ofColor(v);
    }
  };
  if (integerBits == 8 || integerBits == 16) {
    const Transfer transfer = options.raw         ? Transfer::linear
                              : options.gamma > 0 ? Transfer::gamma
                                                  : Transfer::srgb;
    const std::vector<float> color = decodingTable(integerBits, transfer, options.gamma);
    const std::vector<float> alpha = decodingTable(integerBits, Transfer::linear);
    const auto last = static_cast<float>(color.size() - 1);
    const auto index = [&](float v) {
      return static_cast<size_t>(std::lround(std::clamp(v, 0.f, 1.f) * last));
    };
    decodeAll([&](float v) { return color[index(v)]; }, [&](float v) { return alpha[index(v)]; });
  } else if (!options.raw && options.gamma > 0) {
    decodeAll([&](float v) { return std::copysign(std::pow(std::abs(v), options.gamma), v); },
              [](float v) { return v; });
  }
}

}  // namespace

std::vector<float> decodingTable(int bits, Transfer transfer, float gamma) {
  std::vector<float> table(size_t{1} << bits);
  const auto last = static_cast<double>(table.size() - 1);
  for (size_t i = 0; i < table.size(); ++i) {
    const double v = static_cast<double>(i) / last;
    const double srgb = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    table[i] =
        static_cast<float>(transfer == Transfer::srgb    ? srgb
                           : transfer == Transfer::gamma ? std::pow(v, static_cast<double>(gamma))
                                                         : v);
  }
  return table;
}

namespace {

Image makeImage(const StoredImage& stored, const std::string& file, const ImageOptions& options) {
  const std::vector<size_t> select = selectChannels(stored);
  requireFinite(stored, file);
  Image image;
  image.name = file;
  image.width = stored.width, image.height = stored.height;
  image.channels = static_cast<int>(select.size());
  const size_t pixelCount = static_cast<size_t>(stored.width) * static_cast<size_t>(stored.height);
  image.pixels.reserve(pixelCount * select.size());
  for (size_t p = 0; p < pixelCount; ++p)
    for (const size_t c : select)
      image.pixels.push_back(stored.pixels[p * stored.channels.size() + c]);
  decode(image, stored.integerBits, options);
  return image;
}

}  // namespace

Image readImage(const std::string& file, const ImageOptions& options, const Location& from) {
  return makeImage(readStoredImages(file, false, from).front(), file, options);
}

Image readImage(std::span<const std::byte> bytes, const std::string& name,
                const ImageOptions& options) {
  return makeImage(readStoredImage(bytes, name), name, options);
}

}  // namespace lobelia::io
