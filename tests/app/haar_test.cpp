// Haar wavelets: an orthonormal basis, exact on pictures of zeros and ones.
#include "lobelia/app/haar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lobelia/base/random.h"

namespace lobelia::app {
namespace {

constexpr size_t kSide = 16, kPixels = kSide * kSide;

std::vector<float> randomPicture(uint64_t seed, bool binary) {
  Rng rng(seed);
  std::vector<float> pixels(kPixels);
  for (float& v : pixels) {
    v = rng.next1D();
    if (binary) v = v < 0.3f ? 1.f : 0.f;
  }
  return pixels;
}

double energy(std::span<const float> values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum;
}

// The picture whose only coefficient is this one.
std::vector<float> basisFunction(size_t coefficient) {
  std::vector<float> pixels(kPixels, 0.f);
  pixels[coefficient] = 1;
  HaarTransform(kSide).inverse(pixels);
  return pixels;
}

TEST(Haar, BasisFunctionsAreOrthonormal) {
  std::vector<std::vector<float>> basis;
  for (size_t i = 0; i < kPixels; ++i) basis.push_back(basisFunction(i));
  for (size_t i = 0; i < kPixels; ++i)
    for (size_t j = 0; j <= i; ++j) {
      double product = 0;
      for (size_t p = 0; p < kPixels; ++p)
        product += static_cast<double>(basis[i][p]) * static_cast<double>(basis[j][p]);
      ASSERT_EQ(product, i == j ? 1 : 0) << i << ", " << j;
    }
}

// Non-standard: every function but the mean has a square for its support, with as many positive
// pixels as negative ones, all of one size.
TEST(Haar, BasisFunctionsAreSquaresOfHalves) {
  for (size_t i = 1; i < kPixels; ++i) {
    const std::vector<float> f = basisFunction(i);
    size_t positive = 0, negative = 0, x0 = kSide, x1 = 0, y0 = kSide, y1 = 0;
    for (size_t p = 0; p < kPixels; ++p) {
      if (f[p] == 0) continue;
      (f[p] > 0 ? positive : negative) += 1;
      x0 = std::min(x0, p % kSide), x1 = std::max(x1, p % kSide + 1);
      y0 = std::min(y0, p / kSide), y1 = std::max(y1, p / kSide + 1);
    }
    ASSERT_EQ(positive, negative) << i;
    ASSERT_EQ(x1 - x0, y1 - y0) << i;
    ASSERT_EQ(positive + negative, (x1 - x0) * (y1 - y0)) << i;
  }
}

TEST(Haar, PicturesOfZerosAndOnesComeBackExactly) {
  HaarTransform transform(kSide);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<float> picture = randomPicture(seed, true);
    std::vector<float> values = picture;
    transform.forward(values);
    EXPECT_EQ(energy(values), energy(picture)) << "Parseval";
    transform.inverse(values);
    EXPECT_EQ(values, picture);
  }
}

TEST(Haar, CoefficientsAreProductsWithTheBasis) {
  const std::vector<float> picture = randomPicture(3, false);
  std::vector<float> values = picture;
  HaarTransform(kSide).forward(values);
  for (size_t i = 0; i < kPixels; ++i) {
    const std::vector<float> f = basisFunction(i);
    double product = 0;
    for (size_t p = 0; p < kPixels; ++p)
      product += static_cast<double>(f[p]) * static_cast<double>(picture[p]);
    EXPECT_NEAR(double{values[i]}, product, 1e-6) << i;
  }
}

TEST(Haar, ErrorsAreThoseOfThePictureThatIsLeft) {
  HaarTransform transform(kSide);
  const std::vector<float> picture = randomPicture(5, true);
  std::vector<float> all = picture;
  transform.forward(all);
  const CoefficientCounts counts(all);
  for (const size_t terms : {0u, 1u, 7u, 60u, 255u}) {
    std::vector<size_t> order(kPixels);
    for (size_t i = 0; i < kPixels; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return std::abs(all[a]) > std::abs(all[b]); });
    std::vector<float> kept(kPixels, 0.f);
    for (size_t i = 0; i < terms; ++i) kept[order[i]] = all[order[i]];
    transform.inverse(kept);
    double error = 0;
    for (size_t p = 0; p < kPixels; ++p)
      error += std::pow(static_cast<double>(kept[p]) - static_cast<double>(picture[p]), 2);
    EXPECT_NEAR(counts.squaredError(terms), error, 1e-4) << terms;
    EXPECT_LE(counts.terms(counts.squaredError(terms)), terms);
    EXPECT_LE(counts.squaredError(counts.terms(error)), error + 1e-12);
  }
  EXPECT_EQ(counts.terms(energy(picture)), 0u);
  size_t notZero = 0;
  for (const float v : all) notZero += v != 0 ? 1 : 0;
  EXPECT_EQ(counts.terms(0), notZero);
  EXPECT_EQ(counts.squaredError(notZero), 0);
}

TEST(Haar, OtherSizesAreRefused) {
  EXPECT_THROW(HaarTransform(12), std::invalid_argument);
  std::vector<float> pixels(kPixels);
  EXPECT_THROW(HaarTransform(8).forward(pixels), std::invalid_argument);
  EXPECT_THROW(HaarTransform(32).inverse(pixels), std::invalid_argument);
}

}  // namespace
}  // namespace lobelia::app
