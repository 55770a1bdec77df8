// What storing a lobe in eight bytes costs.
#include "lobelia/transfer/slice_record.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::transfer {
namespace {

Vec3f randomAxis(Rng& rng) { return sampleSphereUniform(rng.next2D()); }

float angleBetween(Vec3f a, Vec3f b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / kPi;
}

TEST(SliceRecord, SharesAreWithinA512thOfTheLargest) {
  Rng rng(1);
  float worst = 0;
  for (int i = 0; i < 20000; ++i) {
    // Of all magnitudes that matter, grey ones and coloured ones.
    const float scale = std::exp2(-14 * rng.next1D());
    Rgb share = Rgb(rng.next1D(), rng.next1D(), rng.next1D()) * scale;
    if (i % 4 == 0) share = Rgb(share.x);
    const Rgb back = unpack(pack({share, {0, 0, 0.5f}})).share;
    const Rgb error = max(back - share, share - back);
    if (maxComponent(share) > 0x1p-13f)
      worst = std::max(worst, maxComponent(error) / maxComponent(share));
  }
  EXPECT_LE(worst, 1.0001f / 512);
  EXPECT_GT(worst, 0.9f / 512) << "the bound is said to be tight";
}

// Nearest: rounding takes no side, so that sums over many records keep their energy.
TEST(SliceRecord, SharesAreRoundedToNearest) {
  Rng rng(2);
  double before = 0, after = 0;
  for (int i = 0; i < 50000; ++i) {
    const float share = 0.5f + 0.5f * rng.next1D();
    before += double{share}, after += double{unpack(pack({Rgb(share), {1, 0, 0}})).share.y};
  }
  EXPECT_NEAR(after / before, 1, 3e-5);
}

TEST(SliceRecord, SomeSharesAreExact) {
  for (const Rgb share : {Rgb(1.f), Rgb(0.5f, 0.25f, 1.f), Rgb(0.f, 1.f, 0.f), Rgb(0x1p-10f)})
    EXPECT_EQ(unpack(pack({share, {0, 1, 0}})).share, share);
}

// Where the largest colour rounds up to a bit more than it has bits for.
TEST(SliceRecord, SharesBelowAPowerOfTwoCarry) {
  for (int exponent = -8; exponent <= 2; ++exponent) {
    const float below = std::nextafter(std::ldexp(1.f, exponent), 0.f);
    const Rgb back = unpack(pack({{below, below / 2, 0}, {0, 0, 1}})).share;
    EXPECT_EQ(back, Rgb(std::ldexp(1.f, exponent), std::ldexp(1.f, exponent - 1), 0)) << exponent;
  }
}

TEST(SliceRecord, NoShareIsZero) {
  for (const Rgb share : {Rgb(0.f), Rgb(1e-30f), Rgb(-1.f)}) {
    const SliceRecord record = pack({share, {0.3f, -0.2f, 0.6f}});
    EXPECT_EQ(record.share, 0u);
    EXPECT_EQ(unpack(record).share, Rgb(0.f));
  }
}

TEST(SliceRecord, AxesAreWithinATenthOfADegree) {
  Rng rng(3);
  float worst = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vec3f axis = randomAxis(rng);
    const float size = 0.05f + 0.9f * rng.next1D();
    const Vec3f back = unpack(pack({Rgb(1.f), axis * size})).r;
    worst = std::max(worst, angleBetween(axis, back));
  }
  EXPECT_LT(worst, 0.085f);
  EXPECT_GT(worst, 0.02f) << "22 bits cannot do better";
}

TEST(SliceRecord, AxesOfTheFrameAndFoldsOfTheOctahedronSurvive) {
  for (float x = -1; x <= 1; ++x)
    for (float y = -1; y <= 1; ++y)
      for (float z = -1; z <= 1; ++z) {
        const Vec3f d{x, y, z};
        if (d == Vec3f{}) continue;
        const Vec3f back = unpack(pack({Rgb(1.f), normalize(d) * 0.9f})).r;
        EXPECT_LT(angleBetween(d, back), 0.085f) << x << " " << y << " " << z;
      }
  EXPECT_NEAR(angleBetween(unpack(pack({Rgb(1.f), {0, 0, -0.5f}})).r, {0, 0, -1}), 0, 1e-4);
}

TEST(SliceRecord, KappaIsWithinAPercent) {
  Rng rng(4);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double kappa = std::exp2(-6 + 19 * double{rng.next1D()});  // 1/64 to 8192
    const auto size = static_cast<float>(lobes::meanResultant(kappa));
    const Vec3f r = unpack(pack({Rgb(1.f), randomAxis(rng) * size})).r;
    const double back = lobes::inverseMeanResultant(static_cast<double>(length(r)));
    worst = std::max(worst, std::abs(back / kappa - 1));
  }
  EXPECT_LT(worst, 0.01);
}

// Beyond what is stored the nearest kappa is.
TEST(SliceRecord, KappaStaysInItsRange) {
  const auto kappaOf = [](Vec3f r) {
    const TransferLobe back = unpack(pack({Rgb(1.f), r}));
    EXPECT_TRUE(isFinite(back.r));
    EXPECT_LT(length(back.r), 1);
    return lobes::inverseMeanResultant(static_cast<double>(length(back.r)));
  };
  EXPECT_NEAR(kappaOf({0, 1, 0}), double{kMostKappa}, 0.02 * double{kMostKappa});
  EXPECT_NEAR(kappaOf({0, 0.99999999f, 0}), double{kMostKappa}, 0.02 * double{kMostKappa});
  EXPECT_NEAR(kappaOf({0, 0, 3}), double{kMostKappa}, 0.02 * double{kMostKappa});
  EXPECT_NEAR(kappaOf({}), 1. / 64, 1e-4);
  EXPECT_NEAR(kappaOf({1e-6f, 0, 0}), 1. / 64, 1e-4);
}

// What a file may hold: any bits are a lobe.
TEST(SliceRecord, AnyBitsAreALobe) {
  Rng rng(5);
  for (int i = 0; i < 50000; ++i) {
    const TransferLobe lobe = unpack({rng.nextUint(), rng.nextUint()});
    ASSERT_TRUE(isFinite(lobe.share) && minComponent(lobe.share) >= 0);
    ASSERT_TRUE(isFinite(lobe.r) && length(lobe.r) < 1 && length(lobe.r) > 0);
  }
}

TEST(SliceRecord, StoringTwiceChangesNothingMore) {
  Rng rng(6);
  for (int i = 0; i < 20000; ++i) {
    const Rgb share(rng.next1D(), rng.next1D(), rng.next1D());
    const SliceRecord once = pack({share, randomAxis(rng) * (0.1f + 0.85f * rng.next1D())});
    const TransferLobe first = unpack(once), second = unpack(pack(first));
    // Directions on the fold have two codes.
    ASSERT_EQ(second.share, first.share) << i;
    ASSERT_LT(length(second.r - first.r), 1e-6f) << i;
  }
}

}  // namespace
}  // namespace lobelia::transfer
