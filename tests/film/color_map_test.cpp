// Colours of differences: what is too bright is told from what is too dark, and by how much.
#include "lobelia/film/color_map.h"

#include <gtest/gtest.h>

#include <limits>

namespace lobelia {
namespace {

Film row(const std::vector<float>& grey) {
  Film film;
  film.fullWidth = film.width = static_cast<int>(grey.size());
  film.fullHeight = film.height = 1;
  Layer& layer = film.addLayer("");
  for (size_t i = 0; i < 3 * grey.size(); ++i) layer.values[i] = grey[i / 3];
  return film;
}

std::array<uint8_t, 3> pixel(const std::vector<uint8_t>& pixels, size_t i) {
  return {pixels[3 * i], pixels[3 * i + 1], pixels[3 * i + 2]};
}

TEST(DifferenceColors, SignedOnesAreRedAboveBlueBelowWhiteBetween) {
  const Film reference = row({1, 1, 1, 1});
  const auto pixels = signedDifference(row({1, 3, -1, 1.5f}), reference, 2);
  EXPECT_EQ(pixel(pixels, 0), (std::array<uint8_t, 3>{255, 255, 255}));
  EXPECT_EQ(pixel(pixels, 1), blueWhiteRed(1));
  EXPECT_EQ(pixel(pixels, 2), blueWhiteRed(-1));
  EXPECT_EQ(pixel(pixels, 3), blueWhiteRed(0.25f));
  EXPECT_GT(pixels[3], pixels[5]) << "more red than blue where too bright";
  EXPECT_LT(pixels[6], pixels[8]) << "more blue than red where too dark";
}

TEST(DifferenceColors, AbsoluteOnesDoNotKnowTheSign) {
  const Film reference = row({1, 1, 1});
  const auto pixels = absoluteDifference(row({1.5f, 0.5f, 9}), reference, 2);
  EXPECT_EQ(pixel(pixels, 0), pixel(pixels, 1));
  EXPECT_EQ(pixel(pixels, 0), cubehelix(0.25f));
  EXPECT_EQ(pixel(pixels, 2), cubehelix(1)) << "beyond the scale";
}

TEST(DifferenceColors, WhatIsNotFiniteIsShownAndLeftOutOfMeans) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Film film = row({1, nan, 3}), reference = row({1, 1, 1});
  EXPECT_EQ(pixel(absoluteDifference(film, reference, 1), 1),
            (std::array<uint8_t, 3>{255, 0, 255}));
  EXPECT_EQ(pixel(signedDifference(film, reference, 1), 1), (std::array<uint8_t, 3>{0, 0, 0}));
  EXPECT_NEAR(meanLuminance(film), 2, 1e-5);
}

}  // namespace
}  // namespace lobelia
