#include "lobelia/relight/point_grid.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"

namespace lobelia::relight {
namespace {

std::vector<Vec3f> randomPoints(size_t count, Vec3f box) {
  Rng rng(3);
  std::vector<Vec3f> points;
  for (size_t i = 0; i < count; ++i) {
    const Vec2f xy = rng.next2D();
    points.push_back(Vec3f{xy.x, xy.y, rng.next1D()} * box);
  }
  return points;
}

TEST(PointGrid, NearIsAllWithinTheRadius) {
  const std::vector<Vec3f> points = randomPoints(500, {2, 1, 0.3f});
  const PointGrid grid(points, 0.2f);
  for (const Vec3f p : points) {
    size_t found = 0, all = 0;
    grid.near(p, [&](uint32_t i) {
      EXPECT_LE(length(points[i] - p), 0.2001f);
      ++found;
    });
    for (const Vec3f q : points) all += lengthSquared(q - p) <= 0.2f * 0.2f ? 1 : 0;
    EXPECT_EQ(found, all);
  }
}

TEST(PointGrid, EvenPointsDoNotCrowd) {
  // The candidates of surface samples: 18 in the radius.
  const std::vector<Vec3f> points = randomPoints(20000, {1, 1, 0});
  const float radius = std::sqrt(18 / (kPi * 20000));
  EXPECT_EQ(PointGrid::uncrowded(points, radius), radius);
}

TEST(PointGrid, CrowdsGetASmallerRadius) {
  // All would be near to all.
  const std::vector<Vec3f> points = randomPoints(20000, Vec3f(1.f));
  const float radius = PointGrid::uncrowded(points, 2);
  EXPECT_LT(radius, 0.2f);
  EXPECT_GT(radius, 0.05f) << "no smaller than need be";
  const PointGrid grid(points, radius);
  size_t pairs = 0;
  for (const Vec3f p : points) grid.near(p, [&](uint32_t) { ++pairs; });
  EXPECT_LT(pairs, 300 * points.size());
  // Points in one place end the search, too.
  EXPECT_GT(PointGrid::uncrowded(std::vector<Vec3f>(1000, Vec3f(1.f)), 1), 0);
}

}  // namespace
}  // namespace lobelia::relight
