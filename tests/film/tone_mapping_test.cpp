#include <gtest/gtest.h>

#include "lobelia/film/film.h"

namespace lobelia {
namespace {

Film ramp(int width, float scale) {
  Film film;
  film.fullWidth = film.width = width;
  film.fullHeight = film.height = 1;
  Layer& layer = film.addLayer("");
  for (int x = 0; x < width; ++x) {
    for (int c = 0; c < 3; ++c) {
      layer.values[static_cast<size_t>(x * 3 + c)] =
          scale * static_cast<float>(x + 1) / static_cast<float>(width);
    }
  }
  return film;
}

TEST(Srgb, RoundTrip) {
  for (float v = 0; v <= 1; v += 0.01f) EXPECT_NEAR(decodeSrgb(encodeSrgb(v)), v, 1e-5f);
}

TEST(ToneMapping, DoesNotDependOnTheSceneScale) {
  const Film a = ramp(64, 1), b = ramp(64, 1000);
  EXPECT_EQ(toneMap(a, measureToneCurve(a, {})), toneMap(b, measureToneCurve(b, {})));
}

TEST(ToneMapping, IsMonotonicReachesWhiteAndFollowsExposure) {
  const Film film = ramp(256, 3);
  const std::vector<uint8_t> out = toneMap(film, measureToneCurve(film, {}));
  for (size_t i = 3; i < out.size(); i += 3) EXPECT_GE(out[i], out[i - 3]);
  const std::vector<uint8_t> brighter = toneMap(film, measureToneCurve(film, {.exposure = 2}));
  EXPECT_GT(brighter[30], out[30]);
}

TEST(ToneMapping, ShowsNonFinitePixels) {
  Film film = ramp(4, 1);
  film.layers.at("").values[0] = NAN;
  EXPECT_EQ(countNonFinite(film), 1u);
  const std::vector<uint8_t> out = toneMap(film, measureToneCurve(film, {}));
  EXPECT_EQ(out[0], 255);
  EXPECT_EQ(out[1], 0);
  EXPECT_EQ(out[2], 255);
}

}  // namespace
}  // namespace lobelia
