// What is left of a glossy lobe where something is in the way.
#include "lobelia/transfer/visible_part.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/resultant.h"

namespace lobelia::transfer {
namespace {

constexpr float kKappa = 101;

Vec3f ownResultant(Vec3f axis) { return axis * lobes::meanResultant(kKappa); }

// The part of a vMF lobe that lies on the positive side of a plane, by brute force.
TransferLobe halfSeen(Vec3f axis, Vec3f plane) {
  Rng rng(4);
  Vec3f sum{};
  constexpr int kSamples = 20000;
  int seen = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3f d = lobes::sampleVmf(axis, kKappa, rng.next2D());
    if (dot(d, plane) > 0) sum += d, ++seen;
  }
  const Rgb share(static_cast<float>(seen) / kSamples);
  return {share, seen > 0 ? sum / static_cast<float>(seen) : Vec3f{}};
}

TEST(VisiblePart, NothingInTheWayIsTheOwnLobe) {
  const Vec3f axis = normalize(Vec3f(1, 1, 2));
  VisibleSum sum(ownResultant(axis));
  for (int i = 0; i < 3; ++i) sum.add(1.f / 3, VisiblePart{});
  const VisiblePart part = sum.part();
  EXPECT_TRUE(part.whole);
  const ReflectedLobe lobe{axis, kKappa, Rgb(0.5f)};
  EXPECT_EQ(visibleOf(lobe, part).axis, axis);
  EXPECT_EQ(visibleOf(lobe, part).alpha, Rgb(0.5f));
}

TEST(VisiblePart, MovesWithTheOwnLobe) {
  // Half of the lobe is seen at three directions, past an edge that moves with the eye: the part
  // between them is that of brute force there.
  const auto axisAt = [](float t) { return normalize(Vec3f(std::sin(t), 0.3f, std::cos(t))); };
  for (const float offset : {-0.08f, 0.f, 0.1f}) {
    const auto seenAt = [&](float t) {
      const Vec3f axis = axisAt(t);
      const Vec3f up = normalize(Vec3f(0, 1, 0) - axis * axis.y);
      return halfSeen(axis, up + axis * offset);
    };
    VisibleSum sum(ownResultant(axisAt(0.05f)));
    for (const auto& [t, weight] : {std::pair{0.f, 0.5f}, {0.1f, 0.3f}, {0.1f, 0.2f}})
      sum.add(weight, visiblePart(seenAt(t), ownResultant(axisAt(t))));
    const VisiblePart part = sum.part();
    const ReflectedLobe lobe = visibleOf(ReflectedLobe{axisAt(0.05f), kKappa, Rgb(1)}, part);
    const TransferLobe truth = seenAt(0.05f);
    EXPECT_FALSE(part.whole);
    EXPECT_NEAR(lobe.alpha.x, truth.share.x, 0.01) << offset;
    EXPECT_LT(length(lobe.axis - normalize(truth.r)), 0.006f) << offset;
    EXPECT_NEAR(lobe.kappa / kappaOfResultant(length(truth.r)), 1, 0.05) << offset;
    EXPECT_GT(lobe.kappa, kKappa) << offset;
  }
}

TEST(VisiblePart, AllLobesAsOneAreTheSame) {
  const Vec3f axis = normalize(Vec3f(1, 0, 2));
  Reflection own;
  own.glossy = Rgb(0.2f, 0.4f, 0.6f);
  own.r = ownResultant(axis);
  const LobeMoment all = visibleOf(own, {});
  EXPECT_EQ(all.alpha, own.glossy);
  EXPECT_LT(length(all.first / luminance(own.glossy) - own.r), 1e-6f);
  const TransferLobe seen = halfSeen(axis, normalize(Vec3f(0.1f, 1, 0)));
  const LobeMoment some = visibleOf(own, visiblePart(seen, own.r));
  EXPECT_NEAR(some.alpha.y, 0.4f * seen.share.y, 1e-6);
  EXPECT_LT(length(some.first / luminance(some.alpha) - seen.r), 1e-4f);
}

TEST(VisiblePart, BlockedIsDark) {
  VisibleSum sum(ownResultant({0, 0, 1}));
  sum.add(0.6f, visiblePart({}, ownResultant({0, 0, 1})));
  sum.add(0.4f, visiblePart({}, ownResultant({0, 1, 0})));
  EXPECT_EQ(sum.part().share, Rgb{});
  EXPECT_FALSE(sum.part().whole);
  sum = VisibleSum(ownResultant({0, 0, 1}));
  sum.add(0.75f, visiblePart({}, ownResultant({0, 0, 1})));
  sum.add(0.25f, VisiblePart{});
  EXPECT_EQ(sum.part().share, Rgb(0.25f));
  EXPECT_EQ(sum.part().axis, Vec3f(0, 0, 1));
  EXPECT_NEAR(sum.part().width, 1, 1e-5);
}

TEST(VisiblePart, OppositeSidesMakeAWiderLobe) {
  // The left half here and the right half there: all of the lobe, half as bright.
  const Vec3f axis{0, 0, 1};
  VisibleSum sum(ownResultant(axis));
  sum.add(0.5f, visiblePart(halfSeen(axis, {1, 0, 0}), ownResultant(axis)));
  sum.add(0.5f, visiblePart(halfSeen(axis, {-1, 0, 0}), ownResultant(axis)));
  const VisiblePart part = sum.part();
  EXPECT_NEAR(part.share.x, 0.5f, 0.01);
  EXPECT_LT(length(part.axis - axis), 0.003f);
  EXPECT_NEAR(part.width, 1, 0.03);
}

}  // namespace
}  // namespace lobelia::transfer
