// A colour for a number: cubehelix (Green 2011, "A colour scheme for the display of astronomical
// intensity images", Bulletin of the Astronomical Society of India 39, 289-295), whose perceived
// brightness rises evenly from black to white, on screen and in grey print.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lobelia/film/film.h"

namespace lobelia {

// x in [0, 1]; sRGB, 8 bits. Start 0.5, -1.5 rotations, hue 1, gamma 1 [Green, section 3].
std::array<uint8_t, 3> cubehelix(float x);

struct FalseColors {
  float least = 0, most = 0;    // of the finite values
  std::vector<uint8_t> pixels;  // sRGB; black is `least`, white `most`, magenta not finite
};
// Luminance of layers with colours.
FalseColors falseColors(const Film& film, const std::string& layer);

// Blue to white to red, x in [-1, 1]; sRGB, 8 bits.
std::array<uint8_t, 3> blueWhiteRed(float x);
double meanLuminance(const Film& film);  // of the finite pixels of the picture
// film - reference in luminance, pixel by pixel: the difference itself by blueWhiteRed() and its
// absolute value by cubehelix(); one of `scale` has the end's colour. Where it is not finite, black
// and magenta, which stand for nothing else there.
std::vector<uint8_t> signedDifference(const Film& film, const Film& reference, float scale);
std::vector<uint8_t> absoluteDifference(const Film& film, const Film& reference, float scale);

}  // namespace lobelia
