#include "lobelia/transfer/lobe_fit.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

// Equal masses drawn from vMF lobes with axes at these angles from z in the plane y = 0.
struct Drawn {
  float angle, kappa;
  int count;
};
std::vector<FitPoint> draw(std::initializer_list<Drawn> lobes) {
  Rng random(7, 0);
  std::vector<FitPoint> points;
  for (const Drawn& lobe : lobes)
    for (int i = 0; i < lobe.count; ++i) {
      const Vec3f axis(std::sin(lobe.angle), 0, std::cos(lobe.angle));
      const Vec3f w = lobes::sampleVmf(axis, lobe.kappa, random.next2D());
      const Vec3d d(static_cast<double>(w.x), static_cast<double>(w.y), static_cast<double>(w.z));
      points.push_back({normalize(d), 0.5});
    }
  return points;
}

FitLobe lobeAt(double angle, double kappa, double share) {
  return {{std::sin(angle), 0, std::cos(angle)}, kappa, share};
}

TEST(LobeFit, FindsTheLobesThatPointsWereDrawnFrom) {
  const auto points = draw({{0.2f, 200, 6000}, {0.9f, 20, 2000}});
  FitLobe lobes[] = {lobeAt(0.4, 50, 0.5), lobeAt(0.6, 20, 0.5)};
  fitLobes(points, 100, lobes);
  EXPECT_NEAR(lobes[0].share, 0.75, 0.02);
  EXPECT_NEAR(lobes[0].kappa, 200, 12);
  EXPECT_NEAR(lobes[1].kappa, 20, 2);
  EXPECT_NEAR(std::atan2(lobes[0].axis.x, lobes[0].axis.z), 0.2, 0.01);
  EXPECT_NEAR(std::atan2(lobes[1].axis.x, lobes[1].axis.z), 0.9, 0.02);
}

TEST(LobeFit, KeepsEnergyAndFirstMomentInThePlane) {
  const auto points = draw({{0.1f, 500, 500}, {0.5f, 3, 500}, {1.2f, 40, 300}});
  FitLobe lobes[] = {lobeAt(0.3, 80, 0.5), lobeAt(0.3, 10, 0.5)};
  Vec3d wanted{}, found{};
  double mass = 0, share = 0;
  for (const FitPoint& p : points) wanted += p.w * p.mass, mass += p.mass;
  for (int rounds : {1, 7}) {
    fitLobes(points, rounds, lobes);
    found = {}, share = 0;
    for (const FitLobe& l : lobes)
      found += l.axis * (l.share * lobes::meanResultant(l.kappa)), share += l.share;
    EXPECT_NEAR(share, 1, 1e-9);
    EXPECT_NEAR(found.x, wanted.x / mass, 1e-6);
    EXPECT_NEAR(found.z, wanted.z / mass, 1e-6);
  }
}

// A tail of GGX is farther from a needle than exponentials reach.
TEST(LobeFit, PointsFarFromAllLobes) {
  std::vector<FitPoint> points(50, {{0, 0, 1}, 1.0});
  points.push_back({{1, 0, 0}, 1e-3});
  points.push_back({{-1, 0, 0}, 1e-3});
  FitLobe lobes[] = {lobeAt(0, 8000, 0.5), lobeAt(0.01, 8000, 0.5)};
  fitLobes(points, 10, lobes);
  for (const FitLobe& lobe : lobes) {
    EXPECT_TRUE(std::isfinite(lobe.kappa) && std::isfinite(lobe.share));
    EXPECT_LE(lobe.kappa, static_cast<double>(kMostKappa));
    EXPECT_NEAR(dot(lobe.axis, lobe.axis), 1, 1e-12);
  }
}

TEST(LobeFit, WithoutPointsNothingChanges) {
  FitLobe lobe[] = {lobeAt(0.4, 50, 0.25)};
  fitLobes({}, 5, lobe);
  EXPECT_EQ(lobe[0].kappa, 50);
  EXPECT_EQ(lobe[0].share, 0.25);
}

}  // namespace
}  // namespace lobelia::transfer
