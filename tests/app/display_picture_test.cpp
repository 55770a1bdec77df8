// What a screen shows of a film, against known values; means of passes.
#include "lobelia/app/studio/display_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/app/studio/pass_mean.h"
#include "lobelia/base/random.h"
#include "lobelia/film/color_map.h"

namespace lobelia::app {
namespace {

Film flatFilm(int width, int height, Rgb value) {
  Film film;
  film.fullWidth = film.width = width;
  film.fullHeight = film.height = height;
  Layer& layer = film.addLayer("");
  for (size_t i = 0; i < film.pixelCount(); ++i)
    for (size_t c = 0; c < 3; ++c) layer.values[3 * i + c] = value[static_cast<int>(c)];
  return film;
}
Picture flat(int width, int height, Rgb value) {
  Picture picture;
  picture.film = flatFilm(width, height, value);
  return picture;
}
std::array<uint8_t, 4> at(const Displayed& d, int x, int y) {
  const size_t i = 4 * static_cast<size_t>(y * d.width + x);
  return {d.pixels[i], d.pixels[i + 1], d.pixels[i + 2], d.pixels[i + 3]};
}
std::array<uint8_t, 4> opaque(std::array<uint8_t, 3> c) { return {c[0], c[1], c[2], 255}; }

TEST(DisplayPicture, PicturesAreThoseOfTheToneMapping) {
  Picture picture = flat(4, 3, Rgb(0.2f, 0.5f, 0.9f));
  picture.film.layers.at("").values[3] = NAN;
  DisplaySettings settings;
  settings.curve = measureToneCurve(picture.film, {});
  const std::vector<uint8_t> expected = toneMap(picture.film, settings.curve);
  const Displayed shown = displayPicture(picture, nullptr, settings);
  ASSERT_EQ(shown.pixels.size(), expected.size() / 3 * 4);
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(shown.pixels[i / 3 * 4 + i % 3], expected[i]) << i;
  // Stops on top are a brighter film.
  settings.exposure = 1;
  EXPECT_EQ(displayPicture(flat(1, 1, Rgb(0.1f)), nullptr, settings).pixels[0],
            toneMap(flatFilm(1, 1, Rgb(0.2f)), settings.curve)[0]);
}

TEST(DisplayPicture, SplitsShowTheTruthOnTheRight) {
  const Picture picture = flat(10, 2, Rgb(0.f)), truth = flat(20, 4, Rgb(1.f));
  DisplaySettings settings;
  settings.split = 0.4f;
  const Displayed shown = displayPicture(picture, &truth, settings);
  EXPECT_EQ(shown.width, 10);
  EXPECT_EQ(at(shown, 3, 1), opaque({0, 0, 0}));
  EXPECT_EQ(at(shown, 4, 1), opaque({255, 255, 255})) << "the line";
  EXPECT_EQ(at(shown, 5, 0)[0], toneMap(truth.film, settings.curve)[0]);
  EXPECT_EQ(at(displayPicture(picture, nullptr, settings), 9, 1), opaque({0, 0, 0}));
  settings.split = 1;
  EXPECT_EQ(at(displayPicture(picture, &truth, settings), 9, 1), opaque({0, 0, 0}));
}

TEST(DisplayPicture, SizesMayDiffer) {
  Picture picture = flat(2, 1, Rgb(0.f));
  for (size_t c = 3; c < 6; ++c) picture.film.layers.at("").values[c] = 1e6f;
  DisplaySettings settings;
  settings.width = 6, settings.height = 4;
  const Displayed shown = displayPicture(picture, nullptr, settings);
  EXPECT_EQ(shown.width, 6);
  EXPECT_EQ(at(shown, 2, 3)[1], 0);
  EXPECT_EQ(at(shown, 3, 0)[1], 255);
}

TEST(DisplayPicture, FalseColoursStandForValues) {
  Picture picture = flat(5, 1, Rgb(0.f));
  for (size_t i = 0; i < 15; ++i) picture.film.layers.at("").values[i] = static_cast<float>(i / 3);
  picture.film.layers.at("").values[12] = INFINITY;
  DisplaySettings settings;
  settings.shown = Shown::luminance;
  settings.fixedRange = true, settings.least = 1, settings.most = 3;
  Displayed shown = displayPicture(picture, nullptr, settings);
  EXPECT_EQ(at(shown, 0, 0), opaque(cubehelix(0)));
  EXPECT_EQ(at(shown, 1, 0), opaque(cubehelix(0)));
  EXPECT_EQ(at(shown, 2, 0), opaque(cubehelix(0.5f)));
  EXPECT_EQ(at(shown, 3, 0), opaque(cubehelix(1)));
  EXPECT_EQ(at(shown, 4, 0), opaque({255, 0, 255}));
  settings.fixedRange = false;
  shown = displayPicture(picture, nullptr, settings);
  EXPECT_EQ(shown.least, 0);
  EXPECT_NEAR(shown.most, 2, 1e-6f) << "99 % of four values";
  picture.white = true;
  settings.shown = Shown::illuminance;
  EXPECT_NEAR(displayPicture(picture, nullptr, settings).most, 2 * kPi, 1e-5f);
  const std::vector<uint8_t> legend = legendColors(3);
  EXPECT_TRUE(std::equal(legend.begin() + 8, legend.begin() + 11, cubehelix(1).begin()));
}

TEST(DisplayPicture, ErrorsAreRelativeToTheTruth) {
  const Picture picture = flat(4, 4, Rgb(1.1f)), truth = flat(4, 4, Rgb(1.f));
  DisplaySettings settings;
  settings.shown = Shown::error;
  EXPECT_NEAR(displayPicture(picture, &truth, settings).most, 0.1f / 1.01f, 1e-5f);
  EXPECT_EQ(whyNotShown(picture, &truth, Shown::error), "");
  for (const Shown shown : {Shown::error, Shown::cost, Shown::illuminance})
    EXPECT_NE(whyNotShown(picture, nullptr, shown), "");
}

// The estimate is the spread of the mean, whatever samples passes have.
TEST(PassMean, EstimatesItsError) {
  Rng random(7);
  double squares = 0, estimates = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    PassMean mean;
    for (const int samples : {1, 1, 2, 4, 8, 16, 16, 16}) {
      Film pass = flatFilm(16, 16, Rgb(0.f));
      for (size_t i = 0; i < pass.pixelCount(); ++i) {
        float sum = 0;
        for (int s = 0; s < samples; ++s) sum += random.next1D() < 0.5f ? 0.f : 2.f;
        for (size_t c = 0; c < 3; ++c)
          pass.layers.at("").values[3 * i + c] = sum / static_cast<float>(samples);
      }
      mean.add(pass, samples);
    }
    EXPECT_EQ(mean.samples(), 64);
    const Film film = mean.film();
    EXPECT_EQ(film.layers.at("samples").values[5], 64.f);
    double own = 0;
    for (size_t i = 0; i < film.pixelCount(); ++i)
      own += std::pow(static_cast<double>(film.rgb(i).x) - 1, 2);
    squares += own / static_cast<double>(film.pixelCount());
    estimates += std::pow(mean.relativeError(), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns), 1. / 8, 0.005);
  EXPECT_NEAR(std::sqrt(estimates / kRuns), 1. / 8, 0.005);
}

TEST(PassMean, CountsWhatIsNotFinite) {
  PassMean mean;
  Film pass = flatFilm(2, 1, Rgb(3.f));
  mean.add(pass, 1);
  EXPECT_EQ(mean.relativeError(), 0);
  pass.layers.at("").values[0] = NAN;
  mean.add(pass, 1);
  EXPECT_EQ(mean.nonFinite(), 1u);
  EXPECT_EQ(mean.film().rgb(0).x, 1.5f);
  EXPECT_EQ(mean.film().rgb(1).x, 3.f);
}

}  // namespace
}  // namespace lobelia::app
