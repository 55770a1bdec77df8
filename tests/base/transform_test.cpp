#include "lobelia/base/transform.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

void expectNear(Vec3f a, Vec3f b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

void expectIdentity(const Mat4& m, double tolerance) {
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) EXPECT_NEAR(m.m[i][j], i == j ? 1 : 0, tolerance);
  }
}

Mat4 randomMatrix(Rng& rng, bool affine) {
  Mat4 m;
  for (size_t i = 0; i < (affine ? 3 : 4); ++i) {
    for (size_t j = 0; j < 4; ++j) m.m[i][j] = 2.0 * static_cast<double>(rng.next1D()) - 1;
  }
  return m;
}

TEST(Transform, InverseTimesMatrixIsIdentity) {
  Rng rng(1);
  int inverted = 0;
  for (int i = 0; i < 200; ++i) {
    const Mat4 m = randomMatrix(rng, i % 2 == 0);
    const auto inv = inverse(m);
    if (!inv) continue;
    ++inverted;
    expectIdentity(*inv * m, 1e-9);
    expectIdentity(m * *inv, 1e-9);
  }
  EXPECT_GT(inverted, 190);
}

TEST(Transform, TinyScaleIsNotSingular) {
  const Mat4 m = translation({1e4, 0, 0}) * scaling({1e-6, 1e-6, 1e-9});
  const auto inv = inverse(m);
  ASSERT_TRUE(inv);
  expectIdentity(m * *inv, 1e-9);
}

TEST(Transform, SingularMatricesHaveNoInverse) {
  EXPECT_FALSE(inverse(scaling({1, 0, 1})));
  Mat4 flat;
  flat.m[0] = {1, 2, 3, 0}, flat.m[1] = {2, 4, 6, 0}, flat.m[2] = {0, 0, 1, 0};
  EXPECT_FALSE(inverse(flat));
  Mat4 projective = flat;
  projective.m[3] = {0, 0, 1, 0};
  EXPECT_FALSE(inverse(projective));
  EXPECT_FALSE(inverse(scaling({std::numeric_limits<double>::quiet_NaN(), 1, 1})));
  EXPECT_THROW(Transform(scaling({0, 0, 0})), std::invalid_argument);
}

TEST(Transform, RotationFollowsTheRightHandRule) {
  expectNear(rotation({0, 0, 2}, 90).vector({1, 0, 0}), {0, 1, 0}, 1e-6f);
  expectNear(rotation({1, 0, 0}, 90).vector({0, 1, 0}), {0, 0, 1}, 1e-6f);
  expectNear(rotation({0, 1, 0}, 90).vector({0, 0, 1}), {1, 0, 0}, 1e-6f);
  EXPECT_NEAR(rotation({1, 2, 3}, 77).determinant3(), 1, 1e-12);
  EXPECT_FALSE(rotation({0, 0, 0}, 10).isFinite());
}

// Mitsuba's camera looks along +z with +x to the left of the image.
TEST(Transform, LookAtPutsXToTheLeft) {
  const auto m = lookAt({1, 2, 3}, {1, 2, -7}, {0, 5, 0});
  ASSERT_TRUE(m);
  expectNear(m->vector({0, 0, 1}), {0, 0, -1}, 1e-6f);
  expectNear(m->vector({0, 1, 0}), {0, 1, 0}, 1e-6f);
  // Looking along -z with y up, the viewer's left is -x.
  expectNear(m->vector({1, 0, 0}), {-1, 0, 0}, 1e-6f);
  expectNear(m->point({0, 0, 0}), {1, 2, 3}, 1e-6f);
  EXPECT_NEAR(m->determinant3(), 1, 1e-12);
}

TEST(Transform, LookAtNeedsTwoDirections) {
  EXPECT_FALSE(lookAt({0, 0, 0}, {0, 3, 0}, {0, 1, 0}));
  EXPECT_FALSE(lookAt({0, 0, 0}, {0, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(lookAt({0, 0, 0}, {0, 0, 1}, {0, 0, 0}));
}

TEST(Transform, PointsDivideByWOnlyWhenProjective) {
  Mat4 projective;
  projective.m[3] = {0, 0, 1, 0};
  expectNear(projective.point({2, 4, 2}), {1, 2, 1}, 1e-6f);
  expectNear(translation({1, 2, 3}).point({1, 1, 1}), {2, 3, 4}, 1e-6f);
  expectNear(translation({1, 2, 3}).vector({1, 1, 1}), {1, 1, 1}, 1e-6f);
}

TEST(Transform, NormalsStayOrthogonalToTangents) {
  Rng rng(3);
  for (int i = 0; i < 50; ++i) {
    const Mat4 m = randomMatrix(rng, true);
    if (std::abs(m.determinant3()) < 0.05) continue;
    const Transform t(m);
    const Vec3f tangent = normalize(Vec3f(rng.next1D(), rng.next1D(), rng.next1D() - 0.5f));
    const Vec3f normal = normalize(cross(tangent, Vec3f(0.3f, -0.5f, 0.8f)));
    const Vec3f tn = normalize(t.normal(normal)), tt = normalize(t.vector(tangent));
    EXPECT_NEAR(dot(tn, tt), 0, 1e-5f);
    expectNear(t.inverted().point(t.point(tangent)), tangent, 1e-4f);
  }
}

}  // namespace
}  // namespace lobelia
