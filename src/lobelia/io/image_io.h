// Reading and writing of images (OpenImageIO).
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lobelia/base/error.h"
#include "lobelia/film/film.h"
#include "lobelia/scene/texture.h"

namespace lobelia::io {

// raw: values as stored; otherwise 8/16-bit images are decoded from sRGB (or from `gamma` when > 0).
struct ImageOptions {
  bool raw = false;
  float gamma = 0;   // 0: sRGB, or linear for float formats
};
// Throws InputError (missing, corrupt, absurd size).
Image readImage(const std::string& file, const ImageOptions& options, const Location& from = {});
// The same from the bytes of a file in memory; `name` is what the image and messages call it.
Image readImage(std::span<const std::byte> bytes, const std::string& name,
                const ImageOptions& options);

// Film with all layers of an EXR (or the RGB of any other format); alpha kept.
Film readFilm(const std::string& file);
// EXR, 32-bit float, layers named "layer.R"...; to a temporary name, then renamed. Throws
// RuntimeError, leaving no file.
void writeExr(const std::string& file, const Film& film);
// 8 bits a channel; 1 (grey), 3 (RGB) or 4 (RGBA, colours not multiplied by alpha) channels.
void writePng(const std::string& file, const std::vector<uint8_t>& pixels, int width, int height,
              int channels = 3);

}  // namespace lobelia::io
