// Lobes under Gaussian light against quadrature over the light's directions.
#include <gtest/gtest.h>

#include "bsdf/lobe_examples.h"
#include "lobelia/bsdf/filtered-inl.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

using namespace test;

Rgb filtered(const Lobe& lobe, Vec3f wo, Vec3f axis, float sharpness) {
  const auto from = core::filteredDirection(toCore(wo), toCore(axis), sharpness);
  return fromCore(core::evaluateFiltered(tagsOf(lobe), parametersOf(lobe), toCore(wo), from,
                                         [&](float c) { return lookUpCoat(lobe.table, c); }));
}

// Mean of the lobe over directions distributed as the Gaussian, by midpoints of its samples.
Rgb quadrature(const Lobe& lobe, Vec3f wo, Vec3f axis, float sharpness) {
  constexpr int kSteps = 64;
  Vec3d sum;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec2f u((static_cast<float>(i) + 0.5f) / kSteps,
                    (static_cast<float>(j) + 0.5f) / kSteps);
      const Rgb f = evaluateLobe(lobe, wo, lobes::sampleVmf(axis, sharpness, u));
      sum += {double{f.x}, double{f.y}, double{f.z}};
    }
  const double count = kSteps * kSteps;
  return {static_cast<float>(sum.x / count), static_cast<float>(sum.y / count),
          static_cast<float>(sum.z / count)};
}

Vec3f direction(float degrees, float azimuth) {
  const float t = degrees * kPi / 180;
  return {std::sin(t) * std::cos(azimuth), std::sin(t) * std::sin(azimuth), std::cos(t)};
}

// Light around the mirror direction and away from it, as wide as lobe and light together.
struct Error {
  double l1 = 0, ratio = 0;
};
Error errorOf(const Lobe& lobe, float degrees, float sharpness, float width) {
  const Vec3f wo = direction(degrees, 0), mirror{-wo.x, -wo.y, wo.z};
  double apart = 0, sum = 0, truth = 0;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j) {
      const Vec2f u((static_cast<float>(i) + 0.5f) / 12, (static_cast<float>(j) + 0.5f) / 8);
      const Vec3f axis = lobes::sampleVmf(mirror, 1 / (width * width), u);
      const double value = static_cast<double>(filtered(lobe, wo, axis, sharpness).x);
      const double exact = static_cast<double>(quadrature(lobe, wo, axis, sharpness).x);
      apart += std::abs(value - exact), sum += value, truth += exact;
    }
  return {apart / truth, sum / truth};
}

TEST(FilteredLobe, SharpLightIsADirection) {
  Lobe ward = simple(LobeType::ward, 0.3f, 0.15f, 2);
  Lobe pane = microfacets(Distribution::ggx, 0.3f, 0.3f, Fresnel::thinDielectric);
  pane.type = LobeType::thinTransmission;
  Lobe glass = roughGlass(Distribution::beckmann, 0.3f, 0.3f, 1.5f).lobes[1];
  const std::vector<Lobe> examples{
      simple(LobeType::lambert),
      simple(LobeType::diffuseTransmission),
      simple(LobeType::phong, 40),
      simple(LobeType::sheen, 0.4f),
      ward,
      pane,
      glass,
      microfacets(Distribution::ggx, 0.2f, 0.35f, Fresnel::conductor),
      microfacets(Distribution::beckmann, 0.3f, 0.3f, Fresnel::dielectric),
      microfacets(Distribution::sphericalGaussian, 0.3f, 0.3f, Fresnel::one),
      microfacets(Distribution::phong, 0.3f, 0.3f, Fresnel::one)};
  for (const Lobe& lobe : examples) {
    for (const float degrees : {10.f, 50.f}) {
      const bool through = isTransmission(lobe);
      const Vec3f wo = direction(degrees, 0.4f);
      const bool refracts = lobe.type == LobeType::microfacetTransmission;
      Vec3f wi = direction(refracts ? degrees / 1.5f + 3 : degrees + 7, 3.4f);
      if (through) wi.z = -wi.z;
      const Rgb exact = evaluateLobe(lobe, wo, wi), value = filtered(lobe, wo, wi, 1e6f);
      ASSERT_GT(exact.x, 0) << static_cast<int>(lobe.type);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(value[c], exact[c], 0.003f * exact[c]) << static_cast<int>(lobe.type);
    }
  }
}

TEST(FilteredLobe, CosineLobesAreIntegrated) {
  const Lobe diffuse = simple(LobeType::lambert), through = simple(LobeType::diffuseTransmission);
  for (const float sharpness : {0.5f, 3.f, 20.f, 300.f})
    for (const float degrees : {0.f, 45.f, 80.f, 100.f, 170.f}) {
      const Vec3f wo = direction(30, 1), axis = direction(degrees, 2);
      EXPECT_NEAR(filtered(diffuse, wo, axis, sharpness).x,
                  quadrature(diffuse, wo, axis, sharpness).x, 0.0006f);
      EXPECT_NEAR(filtered(through, wo, axis, sharpness).x,
                  quadrature(through, wo, axis, sharpness).x, 0.0006f);
      // The same seen from the other side of a sheet.
      Lobe both = diffuse;
      both.twoSided = true;
      EXPECT_NEAR(filtered(both, -wo, -axis, sharpness).x, filtered(diffuse, wo, axis, sharpness).x,
                  1e-6f);
    }
}

// Figures of docs/lobes.md.
TEST(FilteredLobe, MicrofacetsAreWidened) {
  for (const auto& [distribution, alpha, sharpness, l1, lost] :
       {std::tuple{Distribution::beckmann, 0.1f, 100.f, 0.03, 0.02},
        std::tuple{Distribution::beckmann, 0.1f, 10.f, 0.19, 0.12},
        std::tuple{Distribution::beckmann, 0.4f, 100.f, 0.03, 0.02},
        std::tuple{Distribution::ggx, 0.1f, 1000.f, 0.03, 0.02},
        std::tuple{Distribution::ggx, 0.1f, 100.f, 0.13, 0.04},
        std::tuple{Distribution::ggx, 0.4f, 30.f, 0.09, 0.05}}) {
    const Lobe lobe = microfacets(distribution, alpha, alpha, Fresnel::one);
    const float width = std::sqrt(4 * alpha * alpha + 2 / sharpness);
    for (const float degrees : {0.f, 40.f}) {
      const Error error = errorOf(lobe, degrees, sharpness, width);
      EXPECT_LT(error.l1, l1) << alpha << ' ' << sharpness << ' ' << degrees;
      EXPECT_NEAR(error.ratio, 1, lost) << alpha << ' ' << sharpness << ' ' << degrees;
    }
  }
}

// At grazing angles a highlight is narrow across the plane of incidence: widening by one number
// would be wrong by half.
TEST(FilteredLobe, HighlightsKeepTheirShapeAtGrazingAngles) {
  const Lobe lobe = microfacets(Distribution::beckmann, 0.1f, 0.1f, Fresnel::one);
  EXPECT_LT(errorOf(lobe, 75, 100, 0.25f).l1, 0.15);
  EXPECT_LT(errorOf(lobe, 75, 30, 0.3f).l1, 0.33);
}

TEST(FilteredLobe, AnisotropicRoughnessKeepsItsAxes) {
  const Lobe lobe = microfacets(Distribution::ggx, 0.1f, 0.4f, Fresnel::one);
  EXPECT_LT(errorOf(lobe, 30, 100, 0.4f).l1, 0.12);
  EXPECT_NEAR(errorOf(lobe, 30, 100, 0.4f).ratio, 1, 0.04);
}

TEST(FilteredLobe, LightBelowTheHorizonCountsByItsShareAbove) {
  const Lobe lobe = microfacets(Distribution::beckmann, 0.3f, 0.3f, Fresnel::one);
  const Vec3f wo = direction(75, 0), axis = direction(95, kPi);
  const float value = filtered(lobe, wo, axis, 30).x, exact = quadrature(lobe, wo, axis, 30).x;
  EXPECT_GT(exact, 0.01f);
  EXPECT_NEAR(value, exact, 0.25f * exact);
  EXPECT_LT(filtered(lobe, wo, direction(170, kPi), 30).x, 1e-6f);
}

}  // namespace
}  // namespace lobelia
