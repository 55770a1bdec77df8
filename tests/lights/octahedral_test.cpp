#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia {
namespace {

double angle(Vec3f a, Vec3f b) {
  const Vec3d x(a.x, a.y, a.z), y(b.x, b.y, b.z);
  return std::atan2(length(cross(x, y)), dot(x, y));
}

TEST(Octahedral, ErrsByLessThanTheHeaderSays) {
  Rng random(1);
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    const Vec3f v = sampleSphereUniform(random.next2D());
    worst = std::max(worst, angle(v, decodeOctahedral(encodeOctahedral(v))));
  }
  EXPECT_LT(worst, 5e-5);
  EXPECT_GT(worst, 1e-5) << "16 bits cannot be that good";
}

TEST(Octahedral, AxesAreExactAndEdgesHold) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.f, 1.f}) {
      Vec3f v;
      v[axis] = sign;
      EXPECT_EQ(decodeOctahedral(encodeOctahedral(v)), v);
    }
  // The folds of the lower half, where signs decide.
  for (const float x : {-1.f, -1e-7f, 0.f, 1e-7f, 1.f})
    for (const float y : {-1.f, -1e-7f, 0.f, 1e-7f, 1.f})
      for (const float z : {-1.f, -1e-7f, 0.f, 1e-7f}) {
        if (std::abs(x) + std::abs(y) + std::abs(z) < 0.5f) continue;
        const Vec3f v = normalize(Vec3f(x, y, z));
        EXPECT_LT(angle(v, decodeOctahedral(encodeOctahedral(v))), 5e-5);
      }
}

TEST(Octahedral, CodesAreStable) {
  Rng random(2);
  for (int i = 0; i < 10000; ++i) {
    const Vec3f v = decodeOctahedral(encodeOctahedral(sampleSphereUniform(random.next2D())));
    EXPECT_LT(angle(v, decodeOctahedral(encodeOctahedral(v))), 1e-6);
  }
}

}  // namespace
}  // namespace lobelia
