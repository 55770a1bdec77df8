// Image metrics of `lobelia compare` (docs/manual.md, compare).
#pragma once

#include <optional>

#include "lobelia/film/film.h"

namespace lobelia {

struct Comparison {
  double rmse = 0, relmse = 0, l2 = 0, mae = 0, meanRatio = 0;
  std::optional<double> flip;  // empty for sparse images
  uint64_t nonfinite = 0;      // values left out
  uint64_t pixels = 0;         // pixels compared
};

// Compares on the pixels that all images (and the mask, where > 0.5) have. Throws InputError when
// sizes differ or no pixel is common. reference2: an independent reference, makes l2 free of the
// references' noise: sqrt(<(A-B)(A-B2)> / <B B2>).
Comparison compare(const Film& image, const Film& reference, const Film* reference2 = nullptr,
                   const Film* mask = nullptr);
// Map (0..1 per pixel) of LDR FLIP (Andersson et al. 2020) of sRGB images, 67 pixels per degree.
std::vector<float> flipMap(const std::vector<uint8_t>& image, const std::vector<uint8_t>& reference,
                           int width, int height);
// The same of linear images, both tone-mapped with the reference's curve.
std::vector<float> flipMap(const Film& image, const Film& reference);
// Difference picture: FLIP map in a perceptual colour map, sRGB 8 bit RGB.
std::vector<uint8_t> differencePicture(const Film& image, const Film& reference);

}  // namespace lobelia
