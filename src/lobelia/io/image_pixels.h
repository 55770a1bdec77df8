// Pixels of image files as stored, by OpenImageIO (internal to io).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lobelia/base/error.h"

namespace lobelia::io {

// One image of a file (EXR files may hold several parts). Integers stand for 0..1; nothing is
// decoded, alpha is not multiplied into the colours (where the format says so).
struct StoredImage {
  std::string part;           // name of the part, often empty
  int width = 0, height = 0;  // data window
  int x0 = 0, y0 = 0;         // its place in the full image
  int fullWidth = 0, fullHeight = 0;
  int integerBits = 0;  // 8, 16...; 0: floats
  std::vector<std::string> channels;
  std::vector<float> pixels;                    // interleaved
  std::map<std::string, std::string> metadata;  // attributes that are texts
};

// Reads the first image, or all. Throws InputError: at `from` when there is no such file, else in
// the file: unknown format, damaged, truncated, too large, of a colour model other than grey or
// RGB.
std::vector<StoredImage> readStoredImages(const std::string& file, bool all, const Location& from);
// The first image of a file's bytes in memory, its format told by them; `name` is what messages
// call it.
StoredImage readStoredImage(std::span<const std::byte> bytes, const std::string& name);

// The linear value of each stored integer of 8 or 16 bits: as it is, by a gamma, or from sRGB.
enum class Transfer : uint8_t { linear, gamma, srgb };
std::vector<float> decodingTable(int bits, Transfer transfer, float gamma = 1);

// Non-finite values make an image useless as a texture or environment: throws InputError.
void requireFinite(const StoredImage& image, const std::string& file);

}  // namespace lobelia::io
