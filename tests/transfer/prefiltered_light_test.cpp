#include "lobelia/transfer/prefiltered_light.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::transfer {
namespace {

// Powers as relight::distantLight() makes them of an image: 512 x 256 cells between poles along y.
template <class F>
relight::DistantLight imageLight(const F& radiance) {
  constexpr int kColumns = 512, kRows = 256;
  relight::DistantLight light;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const float theta = (static_cast<float>(y) + 0.5f) * kPi / kRows;
      const float phi = (static_cast<float>(x) + 0.5f) * kTwoPi / kColumns;
      const Vec3f d{std::sin(theta) * std::sin(phi), std::cos(theta),
                    -std::sin(theta) * std::cos(phi)};
      const float solidAngle =
          kTwoPi / kColumns * 2 * std::sin(0.5f * kPi / kRows) * std::sin(theta);
      const Rgb power = radiance(d) * solidAngle;
      if (power != Rgb{}) light.powers.push_back({d, power});
    }
  return light;
}

TEST(PrefilteredLight, ConstantLightIsConstant) {
  const Rgb colour{0.25f, 0.5f, 2};
  relight::DistantLight known;
  known.everywhere = colour;
  const PrefilteredLight exact(known);
  const PrefilteredLight image(imageLight([&](Vec3f) { return colour; }));
  Rng rng(3);
  for (int i = 0; i < 20000; ++i) {
    const Vec3f d = sampleSphereUniform(rng.next2D());
    const float kappa = std::exp2(15 * rng.next1D() - 3);
    EXPECT_LT(maxComponent(exact.lookUp(d, kappa) - colour), 1e-6f);
    const Rgb found = image.lookUp(d, kappa) / colour;
    // The image's cells are rings about its poles, whose middles are not the middles of their
    // light.
    EXPECT_NEAR(found.x, 1, std::abs(d.y) > 0.998f ? 0.02 : 0.006) << kappa;
    EXPECT_NEAR(found.z, found.x, 1e-5);
  }
}

TEST(PrefilteredLight, GaussianLightIsAProductOfGaussians) {
  const Rgb colour{1, 0.5f, 3};
  // Over a pole of the image, in the middle of nothing, over an edge and a corner of the map.
  std::vector<lobes::SphericalGaussian> sources;
  for (const auto& [axis, sharpness] : {std::pair{Vec3f(0, 1, 0), 40.f},
                                        {Vec3f(0.3f, 0.2f, 0.93f), 500.f},
                                        {Vec3f(0.7f, 0.01f, -0.7f), 200.f},
                                        {Vec3f(-1, -1, -1), 600.f},
                                        {Vec3f(0, -1, 0), 3.f}})
    sources.push_back({normalize(axis), sharpness, std::sqrt(sharpness)});
  const PrefilteredLight light(imageLight([&](Vec3f d) {
    float sum = 0;
    for (const auto& source : sources) sum += lobes::evaluate(source, d);
    return colour * sum;
  }));
  Rng rng(5);
  for (const auto& source : sources)
    for (int i = 0; i < 3000; ++i) {
      const float kappa = std::exp2((std::log2(4 * source.sharpness) + 2) * rng.next1D() - 2);
      const float near = std::min(source.sharpness, kappa) * 0.3f;
      const Vec3f d = lobes::sampleVmf(source.axis, near, rng.next2D());
      float expected = 0;
      for (const auto& g : sources)
        expected += lobes::productIntegral(g, {d, kappa, 1 / lobes::integral(kappa)});
      const float most = std::max(
          expected,
          lobes::productIntegral(source, {source.axis, kappa, 1 / lobes::integral(kappa)}));
      const Rgb found = light.lookUp(d, kappa) / colour;
      // Light much narrower than the lobe is as from one direction: it shows the levels' steps.
      const float tolerance = kappa < source.sharpness / 4 ? 0.018f : 0.01f;
      EXPECT_NEAR(found.x, expected, tolerance * most) << source.sharpness << ' ' << kappa;
      EXPECT_NEAR(found.z, found.x, 1e-5f * most);
    }
}

TEST(PrefilteredLight, LightFromOneDirectionIsTheLobe) {
  const Rgb power{2, 1, 4};
  relight::DistantLight known;
  for (const Vec3f axis : {Vec3f(1, 1, 1), Vec3f(0.01f, -0.02f, -1), Vec3f(0.6f, -0.8f, 0)})
    known.powers.push_back({normalize(axis), power});
  const PrefilteredLight light(known);
  Rng rng(9);
  for (size_t level = 0; level < light.levelCount(); ++level)
    for (int i = 0; i < 1500; ++i) {
      const float kappa = light.kappaOf(level);
      const Vec3f d =
          lobes::sampleVmf(known.powers[rng.nextUint() % 3].direction, 0.3f * kappa, rng.next2D());
      float expected = 0;
      for (const auto& p : known.powers) expected += lobes::vmfPdf(p.direction, kappa, d);
      const Rgb found = light.lookUp(d, kappa) / power;
      EXPECT_NEAR(found.y, expected, 0.021f / lobes::integral(kappa)) << kappa;
      EXPECT_GE(found.y, 0);
    }
}

TEST(PrefilteredLight, ManyLightsAreTheirSum) {
  // Far from regular, so that lumps have one power or many.
  relight::DistantLight known;
  Rng rng(11);
  for (int i = 0; i < 3000; ++i) {
    const Vec3f d = lobes::sampleVmf(normalize(Vec3f(0.1f, 1, 0.2f)), 20, rng.next2D());
    known.powers.push_back({d, Rgb{rng.next1D(), rng.next1D(), 1}});
  }
  known.everywhere = Rgb(0.1f);
  const PrefilteredLight light(known);
  for (size_t level = 0; level < light.levelCount(); ++level)
    for (int i = 0; i < 100; ++i) {
      const float kappa = light.kappaOf(level);
      const Vec3f d = known.powers[rng.nextUint() % 3000].direction;
      Rgb sum = known.everywhere;
      for (const relight::DirectedPower& p : known.powers)
        sum += p.power * lobes::vmfPdf(p.direction, kappa, d);
      const Rgb found = light.lookUp(d, kappa);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], sum[c], 0.035f * sum[c]) << kappa;
    }
}

TEST(PrefilteredLight, SharperAndWiderLobesAreTheLastOnes) {
  relight::DistantLight known;
  known.powers.push_back({{0, 0, 1}, Rgb(1)});
  const PrefilteredLight light(known);
  EXPECT_EQ(light.lookUp({0, 0, 1}, 1e9f), light.lookUp({0, 0, 1}, light.sharpest()));
  const Rgb widest = light.lookUp({0, 0, 1}, 0);
  const Rgb last = light.lookUp({0, 0, 1}, light.kappaOf(light.levelCount() - 1));
  EXPECT_NEAR(widest.x / last.x, 1, 1e-6f);
  EXPECT_NEAR(widest.x, 1 / (4 * kPi), 0.03f);
}

}  // namespace
}  // namespace lobelia::transfer
