// Filter importance sampling against the filters themselves.
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/scene/camera.h"

namespace lobelia {
namespace {

class Filters : public testing::TestWithParam<PixelFilter> {};

TEST_P(Filters, ShapeIsMitsubas) {
  const PixelFilter f = GetParam();
  const float r = defaultRadius(f);
  EXPECT_EQ(evaluateFilter(f, 0, r * 1.001f), 0);
  EXPECT_EQ(evaluateFilter(f, 0, -0.3f * r), evaluateFilter(f, 0, 0.3f * r));
  const double e8 = std::exp(-8.);
  switch (f) {
    case PixelFilter::box:
      EXPECT_EQ(evaluateFilter(f, 0, 0.49f), 1);
      break;
    case PixelFilter::tent:
      EXPECT_FLOAT_EQ(evaluateFilter(f, 0, 0.25f), 0.75f);
      break;
    case PixelFilter::gaussian:
      EXPECT_NEAR(evaluateFilter(f, 0, 0.5f), std::exp(-0.5) - e8, 1e-6);
      break;
    case PixelFilter::mitchell:
      EXPECT_NEAR(evaluateFilter(f, 0, 0), 8. / 9, 1e-6);
      EXPECT_NEAR(evaluateFilter(f, 0, 1), 1. / 18, 1e-6);
      break;
    case PixelFilter::catmullRom:
      EXPECT_NEAR(evaluateFilter(f, 0, 0), 1, 1e-6);
      EXPECT_NEAR(evaluateFilter(f, 0, 1), 0, 1e-6);
      EXPECT_NEAR(evaluateFilter(f, 0, 1.5f), -0.0625, 1e-6);
      break;
    case PixelFilter::lanczos:
      EXPECT_NEAR(evaluateFilter(f, 0, 1.5f), -0.1350949, 1e-5);
      break;
  }
}

// The weighted histogram of offsets along x is the normalised filter: every bin within 5 sigma.
TEST_P(Filters, SamplesFollowTheFilter) {
  const PixelFilter f = GetParam();
  for (const float radius : {0.f, 2.f}) {
    const float r = radius > 0 ? radius : defaultRadius(f);
    constexpr int kBins = 48, kCount = 400000;
    std::vector<double> expected(kBins), histogram(kBins), squares(kBins);
    double total = 0;
    for (int b = 0; b < kBins; ++b) {
      for (int k = 0; k < 64; ++k) {
        const float x = (static_cast<float>(b * 64 + k) + 0.5f) / (kBins * 64) * 2 * r - r;
        expected[static_cast<size_t>(b)] += double{evaluateFilter(f, radius, x)};
      }
      total += expected[static_cast<size_t>(b)];
    }
    Rng rng(7);
    double meanY = 0;
    for (int i = 0; i < kCount; ++i) {
      float weight = 0;
      const Vec2f o = sampleFilter(f, radius, rng.next2D(), &weight);
      ASSERT_LE(std::abs(o.x), r * 1.00001f);
      ASSERT_LE(std::abs(o.y), r * 1.00001f);
      const auto bin = static_cast<size_t>(
          std::clamp(static_cast<int>((o.x + r) / (2 * r) * kBins), 0, kBins - 1));
      histogram[bin] += double{weight}, squares[bin] += double{weight} * double{weight};
      meanY += double{weight} * double{o.y};
    }
    EXPECT_NEAR(meanY / kCount, 0, 0.02);
    for (size_t b = 0; b < kBins; ++b) {
      const double mean = histogram[b] / kCount;
      const double sigma = std::sqrt(std::max(squares[b] / kCount, 1e-9) / kCount);
      EXPECT_NEAR(mean, expected[b] / total, 5 * sigma + 1e-4) << "bin " << b;
    }
    EXPECT_NEAR(std::accumulate(histogram.begin(), histogram.end(), 0.) / kCount, 1, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Filters,
                         testing::Values(PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian,
                                         PixelFilter::mitchell, PixelFilter::catmullRom,
                                         PixelFilter::lanczos));

}  // namespace
}  // namespace lobelia
