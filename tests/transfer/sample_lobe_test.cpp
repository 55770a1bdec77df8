#include "lobelia/transfer/sample_lobe.h"

#include <gtest/gtest.h>

#include "lobelia/base/frame.h"
#include "lobelia/base/random.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::transfer {
namespace {

// A vMF sample about +z.
Vec3f drawn(float kappa, Rng& random) {
  const float t = -std::log1p(random.next1D() * std::expm1(-2 * kappa)) / kappa;
  const float s = std::sqrt(t * (2 - t)), angle = kTwoPi * random.next1D();
  return {s * std::cos(angle), s * std::sin(angle), 1 - t};
}

TEST(SampleLobe, FindsShareDirectionAndWidth) {
  Rng random(3);
  SampleLobe fit;
  for (int i = 0; i < 20000; ++i) fit.add(Rgb(0.5f, 0.25f, 0.125f), drawn(40, random));
  const TransferLobe lobe = fit.lobe(40000, 0);
  EXPECT_NEAR(lobe.share.x, 0.25f, 1e-3f);
  EXPECT_NEAR(lobe.share.z, 0.0625f, 1e-3f);
  EXPECT_NEAR(lobe.r.z, lobes::meanResultant(40.0), 5e-4);
  EXPECT_NEAR(lobe.r.x, 0, 3e-3f);
}

TEST(SampleLobe, FewSamplesLookNoSharper) {
  // The mean over many fits of |r|^2, in which the correction is exact.
  const double truth = lobes::meanResultant(20.0) * lobes::meanResultant(20.0);
  for (const int samples : {4, 16}) {
    Rng random(11);
    double fitted = 0, naive = 0;
    constexpr int kFits = 4000;
    for (int f = 0; f < kFits; ++f) {
      SampleLobe fit;
      Vec3f sum{};
      for (int i = 0; i < samples; ++i) {
        const Vec3f d = drawn(20, random);
        fit.add(Rgb(1), d), sum += d;
      }
      const TransferLobe lobe = fit.lobe(1, 0);
      fitted += double{lengthSquared(lobe.r)} / kFits;
      naive += double{lengthSquared(sum / static_cast<float>(samples))} / kFits;
    }
    EXPECT_NEAR(fitted, truth, 0.15 * (1 - truth) / std::sqrt(samples)) << samples;
    EXPECT_GT(naive - truth, 0.7 * (1 - truth) / samples) << samples;
  }
}

TEST(SampleLobe, OneSampleIsAsWideAsItIsTold) {
  SampleLobe fit;
  EXPECT_TRUE(fit.empty());
  EXPECT_EQ(fit.lobe(1, 0.9f).share, Rgb{});
  fit.add(Rgb(0.5f), {0, 1, 0});
  const TransferLobe lobe = fit.lobe(2, 0.9f);
  EXPECT_FLOAT_EQ(lobe.share.y, 0.25f);
  EXPECT_FLOAT_EQ(lobe.r.y, 0.9f);
  EXPECT_EQ(lobe.r.x, 0);
}

}  // namespace
}  // namespace lobelia::transfer
