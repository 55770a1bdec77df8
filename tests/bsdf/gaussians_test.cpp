// Fits of glossy lobes by spherical Gaussians against the exact lobes, by quadrature.
#include "lobelia/bsdf/gaussians.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/gaussian_mixture.h"
#include "lobelia/bsdf/layers.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobes/sphere_quadrature.h"

namespace lobelia {
namespace {

Lobe microfacet(Distribution distribution, float alphaX, float alphaY) {
  Lobe lobe;
  lobe.type = LobeType::microfacetReflection;
  lobe.distribution = distribution;
  lobe.alphaX = alphaX, lobe.alphaY = alphaY;
  return lobe;
}
Lobe ward(float alphaX, float alphaY) {
  Lobe lobe = microfacet(Distribution::beckmann, alphaX, alphaY);
  lobe.type = LobeType::ward;
  lobe.variant = 1;
  return lobe;
}
Lobe phongLobe(float exponent) {
  Lobe lobe;
  lobe.type = LobeType::phong;
  lobe.alphaX = exponent;
  return lobe;
}
Lobe transmission(float alpha, float eta) {
  Lobe lobe = microfacet(Distribution::ggx, alpha, alpha);
  lobe.type = LobeType::microfacetTransmission;
  lobe.fresnel = Fresnel::dielectric;
  lobe.eta = Rgb(eta);
  lobe.interface = true;
  return lobe;
}

Bsdf bsdfOf(const Lobe& lobe) {
  Bsdf bsdf;
  bsdf.frames[0] = frameFromNormalTangent(normalize(Vec3f(0.2f, -0.4f, 0.9f)), {1, 0.3f, 0});
  bsdf.ng = bsdf.baseNormal = bsdf.frames[0].n;
  bsdf.add(lobe);
  return bsdf;
}

Vec3f direction(const Bsdf& bsdf, float degrees, float azimuth = 0) {
  const float t = degrees * kPi / 180, s = std::sin(t);
  return bsdf.frames[0].toWorld({s * std::cos(azimuth), s * std::sin(azimuth), std::cos(t)});
}

float intensity(const LobeExpansion& e, Vec3f w) {
  float sum = 0;
  for (int i = 0; i < e.count; ++i) {
    const GaussianLobe& g = e.gaussians[static_cast<size_t>(i)];
    if (dot(g.normal, w) > 0) {
      sum += g.amplitude.x * lobes::gaussian(g.axis, g.sharpness, w);
    }
  }
  return sum;
}

struct Fit {
  double error, energy;  // L1 distance and energy over the exact lobe's energy
  double exact;          // that energy
  int count;
};
Fit fitOf(const Bsdf& bsdf, Vec3f wi, int gaussiansPerLobe) {
  const LobeExpansion e = expand(bsdf, wi, gaussiansPerLobe);
  const Vec3f n = bsdf.frames[0].n;
  Vec3f pole = n * (2 * dot(n, wi)) - wi;
  if (e.count > 0 && dot(e.gaussians[0].normal, wi) < 0) {
    pole = e.gaussians[static_cast<size_t>(e.count / 2)].axis;
  }
  double exact = 0, distance = 0;
  const double fit =
      test::integrateSphere(pole, 350, 200, [&](Vec3f w) { return intensity(e, w); });
  exact = test::integrateSphere(pole, 350, 200, [&](Vec3f w) {
    return evaluate(bsdf, wi, w, LobeSet::all, Transport::importance).x;
  });
  distance = test::integrateSphere(pole, 350, 200, [&](Vec3f w) {
    return std::abs(evaluate(bsdf, wi, w, LobeSet::all, Transport::importance).x - intensity(e, w));
  });
  return {distance / exact, fit / exact, exact, e.count};
}

struct Case {
  std::string name;
  Lobe lobe;
  float degrees, azimuth;
  int gaussians;
  double bound;  // of the relative L1 error: docs/lobes.md, rounded up
};

void check(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const Bsdf bsdf = bsdfOf(c.lobe);
    const Fit fit = fitOf(bsdf, direction(bsdf, c.degrees, c.azimuth), c.gaussians);
    const std::string label = c.name + " at " + std::to_string(static_cast<int>(c.degrees)) +
                              " degrees, " + std::to_string(c.gaussians) + " Gaussians";
    EXPECT_LE(fit.error, c.bound) << label;
    EXPECT_NEAR(fit.energy, 1, 0.008) << label;
    EXPECT_LE(fit.count, std::max(c.gaussians, 1)) << label;
    EXPECT_GE(fit.count, 1) << label;
  }
}

TEST(Expand, PaperFormHasTheErrorsOfTheSphericalWarp) {
  using enum Distribution;
  check({{"beckmann .05", microfacet(beckmann, .05f, .05f), 0, 0, 1, 0.006},
         {"beckmann .05", microfacet(beckmann, .05f, .05f), 30, 0, 1, 0.10},
         {"beckmann .05", microfacet(beckmann, .05f, .05f), 60, 0, 1, 0.44},
         {"ggx .05", microfacet(ggx, .05f, .05f), 0, 0, 1, 0.41},
         {"ggx .2", microfacet(ggx, .2f, .2f), 60, 0, 1, 0.54},
         {"phong 50", phongLobe(50), 30, 0, 1, 0.08},
         {"phong 50", phongLobe(50), 60, 0, 1, 0.21}});
}

TEST(Expand, MixturesFollowObliqueLobes) {
  using enum Distribution;
  check({{"beckmann .05", microfacet(beckmann, .05f, .05f), 30, 0, 24, 0.02},
         {"beckmann .05", microfacet(beckmann, .05f, .05f), 60, 0, 24, 0.06},
         {"beckmann .2", microfacet(beckmann, .2f, .2f), 60, 0, 24, 0.07},
         {"beckmann .2", microfacet(beckmann, .2f, .2f), 75, 0, 24, 0.14},
         {"beckmann .4", microfacet(beckmann, .4f, .4f), 60, 0, 24, 0.13},
         {"ward .1", ward(.1f, .1f), 45, 0, 24, 0.04},
         {"ward .1", ward(.1f, .1f), 75, 0, 24, 0.22},
         {"ward .1", ward(.1f, .1f), 45, 0, 9, 0.06}});
}

TEST(Expand, MixturesFollowTheTailsOfGgx) {
  using enum Distribution;
  check({{"ggx .05", microfacet(ggx, .05f, .05f), 0, 0, 24, 0.09},
         {"ggx .1", microfacet(ggx, .1f, .1f), 0, 0, 24, 0.06},
         {"ggx .1", microfacet(ggx, .1f, .1f), 60, 0, 24, 0.14},
         {"ggx .1", microfacet(ggx, .1f, .1f), 75, 0, 24, 0.30},
         {"ggx .2", microfacet(ggx, .2f, .2f), 45, 0, 24, 0.06},
         {"ggx .2", microfacet(ggx, .2f, .2f), 75, 0, 24, 0.19},
         {"ggx .4", microfacet(ggx, .4f, .4f), 0, 0, 24, 0.04},
         {"ggx .4", microfacet(ggx, .4f, .4f), 60, 0, 24, 0.08},
         {"ggx .4", microfacet(ggx, .4f, .4f), 75, 0, 24, 0.12},
         {"ggx .6", microfacet(ggx, .6f, .6f), 60, 0, 24, 0.12},
         {"ggx 1", microfacet(ggx, 1, 1), 75, 0, 24, 0.16},
         {"ggx .4", microfacet(ggx, .4f, .4f), 75, 0, 9, 0.13}});
}

// Sharpness 2 / alpha^2 of the half vector: 800, 50, 12.5. One Gaussian is the warp of [Wang09].
TEST(Expand, CapturedLobesAreWarped) {
  using enum Distribution;
  const Lobe narrow = microfacet(sphericalGaussian, .05f, .05f);
  const Lobe medium = microfacet(sphericalGaussian, .2f, .2f);
  const Lobe wide = microfacet(sphericalGaussian, .4f, .4f);
  check({{"sg 800", narrow, 0, 0, 1, 0.006},
         {"sg 800", narrow, 30, 0, 1, 0.10},
         {"sg 50", medium, 0, 0, 1, 0.05},
         {"sg 800", narrow, 30, 0, 24, 0.02},
         {"sg 800", narrow, 60, 0, 24, 0.06},
         {"sg 50", medium, 60, 0, 24, 0.07},
         {"sg 50", medium, 75, 0, 24, 0.14},
         {"sg 12.5", wide, 60, 0, 24, 0.13}});
  const Bsdf bsdf = bsdfOf(narrow);
  const LobeExpansion one = expand(bsdf, direction(bsdf, 60), 1);
  EXPECT_NEAR(one.gaussians[0].sharpness, 800 / (4 * std::cos(kPi / 3)), 0.5f);
  EXPECT_NEAR(dot(one.gaussians[0].axis, direction(bsdf, 60, kPi)), 1, 1e-5f);
}

TEST(Expand, RowsFollowAnisotropy) {
  using enum Distribution;
  check({{"ward .3/.1", ward(.3f, .1f), 0, .5f, 16, 0.06},
         {"ward .3/.1", ward(.3f, .1f), 45, .5f, 16, 0.16},
         {"ward .2/.1", ward(.2f, .1f), 45, 1.2f, 16, 0.15},
         {"ggx .3/.1", microfacet(ggx, .3f, .1f), 0, .5f, 32, 0.11},
         {"ggx .3/.1", microfacet(ggx, .3f, .1f), 45, .5f, 32, 0.20}});
}

TEST(Expand, PhongIsOneGaussianNearerToTheNormal) {
  check({{"phong 10", phongLobe(10), 0, 0, 16, 0.06},
         {"phong 10", phongLobe(10), 60, 0, 16, 0.10},
         {"phong 50", phongLobe(50), 0, 0, 16, 0.02},
         {"phong 50", phongLobe(50), 60, 0, 16, 0.03},
         {"phong 50", phongLobe(50), 75, 0, 16, 0.08},
         {"phong 200", phongLobe(200), 60, 0, 16, 0.01}});
}

TEST(Expand, TransmissionGoesToTheOtherSide) {
  for (float degrees : {0.f, 45.f, 110.f, 160.f}) {
    const Bsdf bsdf = bsdfOf(transmission(.2f, 1.5f));
    const Vec3f wi = direction(bsdf, degrees, 0.3f);
    const LobeExpansion e = expand(bsdf, wi, 16);
    for (int i = 0; i < e.count; ++i) {
      const GaussianLobe& g = e.gaussians[static_cast<size_t>(i)];
      EXPECT_LT(dot(g.normal, wi), 0) << degrees;
      EXPECT_GT(dot(g.axis, g.normal), 0) << degrees;
    }
    const Fit fit = fitOf(bsdf, wi, 16);
    // Of the light that arrives: at 110 degrees most of it is totally reflected.
    EXPECT_NEAR(fit.energy * fit.exact, fit.exact, 0.005) << degrees;
  }
  check({{"ggx .2 into glass", transmission(.2f, 1.5f), 0, 0, 16, 0.14},
         {"ggx .2 into glass", transmission(.2f, 1.5f), 60, 0, 16, 0.22},
         {"ggx .2 out of glass", transmission(.2f, 1 / 1.5f), 30, 0, 16, 0.14}});
}

// What the light pass needs (issue: mean energy right within 1 % for Phong of moderate gloss and
// 3 % for GGX): here every angle by itself, Fresnel factors included.
TEST(Expand, EnergyIsTheAlbedoAtEveryAngle) {
  std::vector<std::pair<std::string, Lobe>> lobes;
  for (float n : {5.f, 20.f, 100.f}) lobes.emplace_back("phong", phongLobe(n));
  for (float a : {.1f, .3f, .6f}) {
    Lobe lobe = microfacet(Distribution::ggx, a, a);
    lobes.emplace_back("ggx", lobe);
    lobe.fresnel = Fresnel::dielectric, lobe.eta = Rgb(1.5f);
    lobes.emplace_back("ggx dielectric", lobe);
    lobe.fresnel = Fresnel::conductor, lobe.eta = Rgb(0.2f), lobe.k = Rgb(3.9f);
    lobes.emplace_back("ggx conductor", lobe);
  }
  lobes.emplace_back("ggx .4/.1", microfacet(Distribution::ggx, .4f, .1f));
  for (const float a : {.03f, .3f, 1.8f})
    lobes.emplace_back("sg", microfacet(Distribution::sphericalGaussian, a, a));
  lobes.emplace_back("ward .3/.05", ward(.3f, .05f));
  Lobe coated = microfacet(Distribution::ggx, .2f, .2f);
  coated.variant = kCoated;
  coated.fresnel = Fresnel::coatedConductor;
  coated.eta = Rgb(0.2f), coated.k = Rgb(3.9f), coated.parameters.x = 1.5f;
  Lobe sheet = microfacet(Distribution::ggx, .2f, .2f);
  sheet.fresnel = Fresnel::dielectric, sheet.eta = Rgb(1.5f);
  coated.table = layerTransmittance({&sheet, 1}).data();
  sheet.type = LobeType::thinTransmission;
  lobes.emplace_back("coated conductor", coated);
  lobes.emplace_back("thin transmission", sheet);
  for (const auto& [name, lobe] : lobes) {
    const Bsdf bsdf = bsdfOf(lobe);
    for (float degrees : {1.f, 40.f, 70.f, 80.f}) {
      for (int gaussians : {1, 24}) {
        const Fit fit = fitOf(bsdf, direction(bsdf, degrees, 0.7f), gaussians);
        EXPECT_NEAR(fit.energy, 1, 0.01) << name << " " << lobe.alphaX << " at " << degrees;
      }
    }
  }
}

TEST(Expand, DiffuseLobesKeepTheirAlbedo) {
  Lobe lambert;
  lambert.weight = {.5f, .4f, .3f};
  lambert.twoSided = true;
  Lobe through = lambert;
  through.type = LobeType::diffuseTransmission;
  through.weight = Rgb(.2f);
  Lobe coated;
  coated.type = LobeType::coatedDiffuse;
  coated.eta = Rgb(1.5f);
  coated.weight = Rgb(.3f);
  Bsdf bsdf = bsdfOf(lambert);
  bsdf.add(through);
  const LobeExpansion behind = expand(bsdf, direction(bsdf, 130), 9);
  EXPECT_EQ(behind.diffuse, lambert.weight);
  EXPECT_EQ(behind.diffuseTransmitted, through.weight);
  EXPECT_EQ(behind.count, 0);
  bsdf = bsdfOf(coated);
  const Vec3f wi = direction(bsdf, 50);
  const double exact = test::integrateSphere(bsdf.frames[0].n, 400, 64,
                                             [&](Vec3f w) { return evaluate(bsdf, wi, w).x; });
  EXPECT_NEAR(static_cast<double>(expand(bsdf, wi, 9).diffuse.x) / exact, 1, 0.005);
}

TEST(Expand, LeavesOutSharpLobesAndClosedSides) {
  Lobe sharp = microfacet(Distribution::ggx, .01f, .01f);
  sharp.sharp = true;
  Lobe mirror;
  mirror.type = LobeType::deltaReflection;
  Bsdf bsdf = bsdfOf(sharp);
  bsdf.add(mirror);
  EXPECT_EQ(expand(bsdf, direction(bsdf, 20), 9).count, 0);
  bsdf.add(microfacet(Distribution::ggx, .3f, .3f));
  EXPECT_GT(expand(bsdf, direction(bsdf, 20), 9).count, 0);
  EXPECT_EQ(expand(bsdf, direction(bsdf, 120), 9).count, 0);  // one-sided, from behind
}

// Nothing that a scene may hold makes a light that is not a number or does not fit the record.
TEST(Expand, IsFiniteForEveryLobeAndAngle) {
  Rng rng(3);
  for (int i = 0; i < 6000; ++i) {
    Bsdf bsdf;
    bsdf.frames[0] = frameFromNormal(sampleSphereUniform(rng.next2D()));
    bsdf.ng = bsdf.frames[0].n;
    const int lobeCount = 1 + static_cast<int>(rng.nextUint() % 3);
    for (int k = 0; k < lobeCount; ++k) {
      const auto alpha = [&] { return std::exp(-7 * rng.next1D()); };
      Lobe lobe = microfacet(static_cast<Distribution>(rng.nextUint() % 3), alpha(), alpha());
      const uint32_t kind = rng.nextUint() % 6;
      if (kind == 5) lobe.type = LobeType::thinTransmission;
      if (kind == 0) lobe = phongLobe(std::exp(9 * rng.next1D()));
      if (kind == 1) lobe = ward(alpha(), alpha());
      if (kind == 2) lobe = transmission(alpha(), 0.5f + 2 * rng.next1D());
      if (kind == 3) lobe.distribution = Distribution::sphericalGaussian, lobe.alphaY = lobe.alphaX;
      lobe.twoSided = rng.next1D() < 0.5f;
      bsdf.add(lobe);
    }
    Vec3f wi = sampleSphereUniform(rng.next2D());
    if (i % 5 == 0) wi = normalize(wi - bsdf.frames[0].n * (dot(wi, bsdf.frames[0].n) * 0.9999f));
    if (i % 7 == 0) wi = bsdf.frames[0].n;
    const LobeExpansion e = expand(bsdf, wi, 1 + static_cast<int>(rng.nextUint() % 32));
    ASSERT_LE(e.count, LobeExpansion::kMaxGaussians);
    for (int k = 0; k < e.count; ++k) {
      const GaussianLobe& g = e.gaussians[static_cast<size_t>(k)];
      ASSERT_TRUE(isFinite(g.amplitude) && minComponent(g.amplitude) >= 0);
      ASSERT_TRUE(std::isfinite(g.sharpness) && g.sharpness > 0);
      ASSERT_NEAR(length(g.axis), 1, 1e-4f);
    }
  }
}

TEST(FitMixture, RefusesSamplesThatAreNotFinite) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const LobeSample good{{0, 0, 1}, 1, 0.1f};
  for (const LobeSample& bad :
       {LobeSample{{kNaN, 0, 1}, 1, 0.1f}, {{0, 0, 1}, kNaN, 0.1f}, {{0, 0, 1}, 1, 1 / 0.f}}) {
    const std::vector<LobeSample> samples{good, bad};
    ShapePart part{{0, 0, 1}, 10, 1};
    EXPECT_THROW(fitMixture(samples, 2, true, {&part, 1}), std::invalid_argument);
    EXPECT_EQ(part.sharpness, 10) << "left as it was";
    EXPECT_THROW(mixtureError(samples, {&part, 1}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace lobelia
