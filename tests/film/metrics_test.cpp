#include "lobelia/film/metrics.h"

#include <gtest/gtest.h>

#include "lobelia/base/error.h"
#include "lobelia/base/random.h"

namespace lobelia {
namespace {

Film makeFilm(int width, int height, Rgb value) {
  Film film;
  film.fullWidth = film.width = width;
  film.fullHeight = film.height = height;
  Layer& layer = film.addLayer("");
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    for (size_t c = 0; c < 3; ++c) layer.values[i * 3 + c] = value[static_cast<int>(c)];
  }
  return film;
}

Film withNoise(Film film, float sigma, uint64_t seed) {
  Rng rng(seed);
  for (float& v : film.layers.at("").values) v += sigma * (rng.next1D() - 0.5f) * std::sqrt(12.f);
  return film;
}

TEST(Compare, EqualImagesHaveNoError) {
  const Film film = withNoise(makeFilm(40, 30, {0.2f, 0.4f, 0.6f}), 0.05f, 1);
  const Comparison r = compare(film, film);
  EXPECT_EQ(r.rmse, 0);
  EXPECT_EQ(r.l2, 0);
  EXPECT_EQ(r.mae, 0);
  EXPECT_EQ(r.meanRatio, 1);
  ASSERT_TRUE(r.flip.has_value());
  EXPECT_EQ(*r.flip, 0);
}

TEST(Compare, KnownDifference) {
  const Comparison r = compare(makeFilm(8, 8, {1, 1, 1}), makeFilm(8, 8, {0.5f, 0.5f, 0.5f}));
  EXPECT_NEAR(r.rmse, 0.5, 1e-7);
  EXPECT_NEAR(r.relmse, 0.25 / 0.26, 1e-7);
  EXPECT_NEAR(r.l2, 1, 1e-7);
  EXPECT_NEAR(r.mae, 0.5, 1e-7);
  EXPECT_NEAR(r.meanRatio, 2, 1e-7);
  EXPECT_GT(*r.flip, 0.1);
}

// An exact image against noisy references: one reference shows its own noise, two do not.
TEST(Compare, SecondReferenceRemovesTheirNoise) {
  const Film truth = makeFilm(200, 200, {0.5f, 0.5f, 0.5f});
  const Film b1 = withNoise(truth, 0.1f, 1), b2 = withNoise(truth, 0.1f, 2);
  EXPECT_NEAR(compare(truth, b1).l2, 0.2, 0.02);
  EXPECT_LT(compare(truth, b1, &b2).l2, 0.03);
  Film wrong = makeFilm(200, 200, {0.55f, 0.55f, 0.55f});
  EXPECT_NEAR(compare(wrong, b1, &b2).l2, 0.1, 0.01);
}

TEST(Compare, CountsNonFiniteAndLeavesThemOut) {
  Film film = makeFilm(4, 4, {1, 1, 1});
  film.layers.at("").values[5] = NAN;
  const Comparison r = compare(film, makeFilm(4, 4, {1, 1, 1}));
  EXPECT_EQ(r.nonfinite, 1u);
  EXPECT_EQ(r.rmse, 0);
  EXPECT_FALSE(r.flip.has_value());
}

TEST(Compare, SparseImagesUseCommonPixelsOnly) {
  Film film = makeFilm(4, 4, {1, 1, 1}), reference = makeFilm(4, 4, {1, 1, 1});
  film.alpha.assign(16, 0);
  film.alpha[3] = film.alpha[7] = 1;
  reference.layers.at("").values[0] = 100;
  const Comparison r = compare(film, reference);
  EXPECT_EQ(r.pixels, 2u);
  EXPECT_EQ(r.rmse, 0);
  EXPECT_FALSE(r.flip.has_value());
}

TEST(Compare, RefusesDifferentSizesAndNothingInCommon) {
  EXPECT_THROW(compare(makeFilm(4, 4, {}), makeFilm(4, 5, {})), InputError);
  Film film = makeFilm(4, 4, {});
  film.alpha.assign(16, 0);
  EXPECT_THROW(compare(film, makeFilm(4, 4, {})), InputError);
}

// The published bounds: equal images 0; black against white close to 1 (Andersson et al. 2020,
// section 4: the metric spans [0,1]). A shifted edge scores in between and the score grows with
// contrast.
TEST(Flip, SpansItsRange) {
  const int n = 64;
  const std::vector<uint8_t> black(n * n * 3, 0), white(n * n * 3, 255);
  for (float v : flipMap(black, black, n, n)) EXPECT_EQ(v, 0.f);
  double sum = 0;
  for (float v : flipMap(black, white, n, n)) sum += v;
  EXPECT_GT(sum / (n * n), 0.85);
  EXPECT_LE(sum / (n * n), 1.0);
  const auto edgeImage = [&](int position, uint8_t value) {
    std::vector<uint8_t> image(n * n * 3, 60);
    for (int y = 0; y < n; ++y) {
      for (int x = position; x < n; ++x) {
        for (int c = 0; c < 3; ++c) image[static_cast<size_t>((y * n + x) * 3 + c)] = value;
      }
    }
    return image;
  };
  const auto score = [&](uint8_t value) {
    double total = 0;
    for (float v : flipMap(edgeImage(30, value), edgeImage(33, value), n, n)) total += v;
    return total;
  };
  EXPECT_GT(score(90), 0);
  EXPECT_GT(score(200), score(90));
}

}  // namespace
}  // namespace lobelia
