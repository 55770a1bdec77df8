// Captured reflectance: tables of known materials are fitted, known lobes recovered.
#include "lobelia/bsdf/captured_fit.h"

#include <gtest/gtest.h>

#include "bsdf/captured_tables.h"
#include "bsdf/lobe_examples.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/captured.h"
#include "lobelia/bsdf/nonnegative_least_squares.h"

namespace lobelia::test {
namespace {

TEST(HalfDifference, AnglesAndDirectionsAreEachOthersInverse) {
  Rng rng(4);
  for (int n = 0; n < 2000; ++n) {
    const Vec3f wo = sampleHemisphereCosine(rng.next2D()),
                wi = sampleHemisphereCosine(rng.next2D());
    const HalfDifference a = toHalfDifference(wo, wi);
    const DirectionPair pair = toDirections(a);
    // Up to a turn about the normal and an exchange of the two.
    EXPECT_NEAR(dot(pair.wo, pair.wi), dot(wo, wi), 1e-5f);
    EXPECT_NEAR(pair.wo.z + pair.wi.z, wo.z + wi.z, 1e-5f);
    EXPECT_NEAR(pair.wo.z * pair.wi.z, wo.z * wi.z, 1e-5f);
    const HalfDifference swapped = toHalfDifference(wi, wo);
    EXPECT_NEAR(swapped.thetaD, a.thetaD, 1e-4f);
    EXPECT_NEAR(std::sin(2 * swapped.phiD), std::sin(2 * a.phiD), 2e-2f);
    EXPECT_LT(TabulatedBrdf::index(a), TabulatedBrdf::kSize);
  }
  for (const int h : {0, 17, 89})
    for (const int d : {0, 40, 89})
      for (const int p : {0, 90, 179})
        EXPECT_EQ(TabulatedBrdf::index(TabulatedBrdf::centre(h, d, p)),
                  TabulatedBrdf::index(h, d, p));
}

TEST(NonnegativeLeastSquares, LeavesOutWhatWouldBeNegative) {
  // Columns (1,0), (1,1), data (1,-1): freely x = (2, -1); nonnegative (1, 0).
  const Matrix8 a{Vector8{1, 1}, Vector8{1, 2}};
  const Vector8 b{1, 0};
  const Vector8 x = solveNonnegative(a, b, 2);
  EXPECT_NEAR(x[0], 1, 1e-12);
  EXPECT_EQ(x[1], 0);
  const Vector8 y = solveNonnegative(a, {3, 4}, 2);
  EXPECT_NEAR(y[0], 2, 1e-12);
  EXPECT_NEAR(y[1], 1, 1e-12);
  // Twice the same column: any split will do.
  const Vector8 z = solveNonnegative({Vector8{1, 1}, Vector8{1, 1}}, {1, 1}, 2);
  EXPECT_NEAR(z[0] + z[1], 1, 1e-12);
}

void expectRecovered(float ior) {
  const Rgb wide = Rgb(0.25f, 0.2f, 0.1f) / projectedIntegral(9);
  const Rgb narrow = Rgb(0.3f, 0.35f, 0.5f) / projectedIntegral(260);
  Bsdf bsdf = single(capturedDiffuse({0.2f, 0.1f, 0.3f}, ior));
  bsdf.add(capturedLobe(wide, 9, ior));
  bsdf.add(capturedLobe(narrow, 260, ior));
  const CapturedFit fit = fitCaptured(tabulate(bsdf), 2);
  ASSERT_EQ(fit.lobes.size(), 2u);
  EXPECT_LT(fit.error, 0.005);
  EXPECT_LT(fit.energyError, 0.002);
  EXPECT_NEAR(fit.ior, ior, 0.03f);
  EXPECT_NEAR(fit.lobes[0].sharpness, 260, 6);
  EXPECT_NEAR(fit.lobes[1].sharpness, 9, 0.5f);
  EXPECT_NEAR(fit.diffuse.z, 0.3f, 0.01f);
  if (ior == 1) {
    EXPECT_NEAR(fit.lobes[0].amplitude.x / narrow.x, 1, 0.03f);
    EXPECT_NEAR(fit.lobes[1].amplitude.z / wide.z, 1, 0.05f);
  }
}

TEST(CapturedFit, RecoversKnownLobes) { expectRecovered(1); }

TEST(CapturedFit, RecoversKnownLobesUnderAFresnelTerm) { expectRecovered(1.5f); }

// Not of the model's own kind: the error that docs/manual.md quotes.
TEST(CapturedFit, FollowsGgx) {
  Bsdf bsdf = single(simple(LobeType::lambert));
  bsdf.lobes[0].weight = {0.1f, 0.2f, 0.3f};
  Lobe gloss = microfacets(Distribution::ggx, 0.2f, 0.2f, Fresnel::one);
  gloss.weight = Rgb(0.5f);
  bsdf.add(gloss);
  const TabulatedBrdf table = tabulate(bsdf);
  const CapturedFit one = fitCaptured(table, 1), three = fitCaptured(table, 3);
  EXPECT_LT(three.error, 0.03);
  EXPECT_LT(three.error, 0.6 * one.error);
  EXPECT_LT(three.energyError, 0.02);
  // The same by the albedo for light from 45 degrees.
  Bsdf fitted = single(capturedDiffuse(three.diffuse, three.ior));
  for (const FittedLobe& lobe : three.lobes)
    fitted.add(capturedLobe(lobe.amplitude, lobe.sharpness, three.ior));
  const Vec3f wo = directionAt(0.7071f, 0);
  EXPECT_NEAR(albedo(fitted, wo).y / albedo(bsdf, wo).y, 1, 0.03f);
}

TEST(CapturedFit, IsTheSameForAnyNumberOfThreads) {
  Bsdf bsdf = single(microfacets(Distribution::ggx, 0.3f, 0.3f, Fresnel::conductor));
  const TabulatedBrdf table = tabulate(bsdf);
  const CapturedFit many = fitCaptured(table, 1);
  const ThreadLimit limit(1);
  const CapturedFit one = fitCaptured(table, 1);
  ASSERT_EQ(many.lobes.size(), one.lobes.size());
  EXPECT_EQ(many.lobes[0].sharpness, one.lobes[0].sharpness);
  EXPECT_EQ(many.lobes[0].amplitude, one.lobes[0].amplitude);
  EXPECT_EQ(many.diffuse, one.diffuse);
}

TEST(CapturedScale, BoundsTheAlbedo) {
  Rng rng(8);
  for (int n = 0; n < 40; ++n) {
    const float ior = n % 2 == 0 ? 1.f : 1.2f + 0.8f * rng.next1D();
    const float sharpness = std::exp(rng.next1D() * 7);
    const Rgb diffuse(rng.next1D(), rng.next1D(), rng.next1D());
    const Rgb weight = Rgb(2 * rng.next1D(), rng.next1D(), 1.f);
    const float scale = capturedScale(diffuse, weight, ior);
    ASSERT_LE(scale, 1.f);
    Bsdf bsdf = single(capturedDiffuse(diffuse * scale, ior));
    bsdf.add(capturedLobe(weight * (scale / projectedIntegral(sharpness)), sharpness, ior));
    for (const float cosine : {1.f, 0.8f, 0.5f, 0.25f, 0.08f})
      EXPECT_LT(maxComponent(albedo(bsdf, directionAt(cosine, 0))), 1.005f)
          << "ior " << ior << " sharpness " << sharpness << " at " << cosine;
  }
}

}  // namespace
}  // namespace lobelia::test
