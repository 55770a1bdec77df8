// Interpolation of lobes, against lobes that are known in between.
#include "lobelia/transfer/lobe_sum.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/geodesic_grid.h"
#include "lobelia/transfer/resultant.h"

namespace lobelia::transfer {
namespace {

Vec3f mirrored(Vec3f d, Vec3f n) { return n * (2 * dot(n, d)) - d; }

TransferLobe lobeAbout(Vec3f axis, float kappa, Rgb share = Rgb(1)) {
  return {share, axis * lobes::meanResultant(kappa)};
}

TEST(LobeSum, MirroredLobesStayAsSharpBetweenDirections) {
  const GeodesicGrid grid(3);
  const Vec3f first = normalize(Vec3f(0.2f, -0.1f, 1)), second = normalize(Vec3f(-1, 0.3f, 0.5f));
  Rng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3f d = sampleSphereUniform(rng.next2D());
    const GridPlace place = grid.locate(d);
    // A mirror that shows another one: what the eye sees turns as the eye does.
    LobeSum sum;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3f to = grid.directions()[place.index[k]];
      sum.add(place.weight[k], lobeAbout(-mirrored(mirrored(to, first), second), 257),
              mirrored(to, first));
    }
    const TransferLobe lobe = sum.lobe();
    EXPECT_NEAR(kappaOfResultant(length(lobe.r)) / 257, 1, 2e-3);
    EXPECT_LT(length(normalize(lobe.r) + mirrored(mirrored(d, first), second)), 2e-3f);
    EXPECT_NEAR(lobe.share.y, 1, 1e-5);
  }
}

TEST(LobeSum, LobesOfOtherObjectsMakeAWiderOne) {
  // A third of each: 60 degrees apart, seen by mirrors two degrees apart.
  LobeSum sum;
  Vec3f moment{};
  for (int k = 0; k < 3; ++k) {
    const float phi = kTwoPi * static_cast<float>(k) / 3;
    const auto tilted = [&](float degrees) {
      const float t = degrees * kPi / 180;
      return Vec3f(std::sin(t) * std::cos(phi), std::sin(t) * std::sin(phi), std::cos(t));
    };
    sum.add(1.f / 3, lobeAbout(tilted(30), 500), tilted(1));
    moment += tilted(30) * (lobes::meanResultant(500.f) / 3);
  }
  const float size = length(sum.lobe().r);
  EXPECT_GE(size, length(moment));
  EXPECT_LT(size, length(moment) + 0.001f);
}

TEST(LobeSum, KeepsEnergyAndWeighsByIt) {
  LobeSum sum;
  EXPECT_TRUE(sum.empty());
  EXPECT_EQ(sum.lobe().share, Rgb{});
  const Vec3f x{1, 0, 0}, y{0, 1, 0};
  sum.add(0.5f, lobeAbout(x, 10, Rgb(0.8f, 0.4f, 0)), x);
  sum.add(0.25f, lobeAbout(y, 10, Rgb(0, 0.4f, 0.8f)), y);
  sum.add(0.25f, {}, y);
  const TransferLobe lobe = sum.lobe();
  EXPECT_NEAR(lobe.share.x, 0.4f, 1e-6);
  EXPECT_NEAR(lobe.share.y, 0.3f, 1e-6);
  EXPECT_NEAR(lobe.share.z, 0.2f, 1e-6);
  const float atX = 0.5f * luminance(Rgb(0.8f, 0.4f, 0)),
              atY = 0.25f * luminance(Rgb(0, 0.4f, 0.8f));
  EXPECT_NEAR(lobe.r.x / lobe.r.y, atX / atY, 1e-4f * atX / atY);
  EXPECT_EQ(lobe.r.z, 0);
}

TEST(LobeSum, OneLobeIsItself) {
  LobeSum sum;
  const TransferLobe one = lobeAbout(normalize(Vec3f(1, 2, 3)), 77, Rgb(0.1f, 0.2f, 0.3f));
  sum.add(1, one, {0, 0, 1});
  EXPECT_LT(length(sum.lobe().r - one.r), 1e-6f);
  EXPECT_EQ(sum.lobe().share, one.share);
}

}  // namespace
}  // namespace lobelia::transfer
