// The frame buffer: named layers of linear RGB (or one channel) over the data window, and what a
// picture file carries beside its pixels.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia {

struct Layer {
  int channels = 3;
  std::vector<float> values;  // width * height * channels of the data window, row-major
};

// An image in memory: full size, data window, layers. The layer "" is the picture (RGB); others
// are AOVs ("albedo", "normal", "depth", "direct", "indirect", "specular", "variance").
struct Film {
  int fullWidth = 0, fullHeight = 0;          // display window
  int x0 = 0, y0 = 0, width = 0, height = 0;  // data window
  std::map<std::string, Layer> layers;
  std::vector<float> alpha;  // empty: opaque; else 1 where computed (--pixels)
  std::map<std::string, std::string> metadata;
  bool forDisplay = false;  // read from 8 or 16 bits: tone-mapped, mostly, and white at most

  Layer& addLayer(const std::string& name, int channels = 3);
  Rgb rgb(size_t pixel, const std::string& layer = "") const;
  size_t pixelCount() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

// Number of non-finite values in the picture.
uint64_t countNonFinite(const Film& film);

// Reinhard et al. 2002, global operator: luminance scaled by key / log-average, then
// L (1 + L / white^2) / (1 + L).
struct ToneMapping {
  float exposure = 0;  // stops, on top of the automatic scale
  float key = 0.18f;
};
// The operator measured on one picture, so that others (a difference's two sides, an animation's
// frames) can be shown with the same one.
struct ToneCurve {
  float scale = 1;
  float white = 1;
};
ToneCurve measureToneCurve(const Film& film, const ToneMapping& settings,
                           const std::string& layer = "");
// sRGB-encoded 8-bit RGB of the data window. Non-finite pixels are magenta.
std::vector<uint8_t> toneMap(const Film& film, const ToneCurve& curve,
                             const std::string& layer = "");
float encodeSrgb(float linear);
float decodeSrgb(float encoded);

}  // namespace lobelia
