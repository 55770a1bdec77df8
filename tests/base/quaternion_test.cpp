// Rotations as quaternions against matrices.
#include "lobelia/base/quaternion.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

double difference(const Mat4& a, const Mat4& b) {
  double largest = 0;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a.m[i][j] - b.m[i][j]));
  return largest;
}

Vec3d randomAxis(Rng& random) {
  const auto number = [&] { return 2 * static_cast<double>(random.next1D()) - 1; };
  return normalize(Vec3d(number(), number(), number()));
}

TEST(Quaternion, OfAMatrixGivesTheMatrix) {
  Rng random(1, 1);
  for (int i = 0; i < 1000; ++i) {
    // Angles near half a turn are those that a naive conversion loses.
    const double angle = i % 2 == 0 ? 180 + (i - 500) * 1e-9 : i * 0.36;
    const Mat4 m = rotation(randomAxis(random), angle);
    EXPECT_LT(difference(rotation(quaternion(m)), m), 1e-14) << angle;
  }
  for (const Vec3d axis : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
    EXPECT_LT(difference(rotation(quaternion(rotation(axis, 180))), rotation(axis, 180)), 1e-14);
}

TEST(Quaternion, SlerpTurnsEvenlyAndTheShortWay) {
  Rng random(2, 1);
  for (int i = 0; i < 200; ++i) {
    const Vec3d axis = randomAxis(random);
    const Mat4 start = rotation(randomAxis(random), 360 * static_cast<double>(random.next1D()));
    const double angle = 340 * (static_cast<double>(random.next1D()) - 0.5);
    const Quaternion a = quaternion(start), b = quaternion(rotation(axis, angle) * start);
    EXPECT_NEAR(angleBetween(a, b), std::abs(angle) * 3.14159265358979 / 180, 1e-9);
    for (const double t : {-0.5, 0., 0.25, 0.5, 1., 1.3}) {
      const Mat4 expected = rotation(axis, angle * t) * start;
      EXPECT_LT(difference(rotation(slerp(a, b, t)), expected), 1e-9) << angle << " " << t;
    }
  }
}

TEST(Quaternion, SlerpOfNearlyEqualOnesLosesNothing) {
  const Quaternion a = quaternion(rotation({1, 2, 3}, 40));
  for (const double degrees : {0., 1e-14, 1e-9, 1e-6, 1e-3}) {
    const Quaternion b = quaternion(rotation({1, 2, 3}, 40 + degrees));
    EXPECT_LT(difference(rotation(slerp(a, b, 0.5)), rotation({1, 2, 3}, 40 + degrees / 2)), 1e-14);
  }
}

}  // namespace
}  // namespace lobelia
