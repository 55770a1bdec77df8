#include "lobelia/base/frame.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"

namespace lobelia {
namespace {

void expectOrthonormal(const Frame& f) {
  EXPECT_NEAR(lengthSquared(f.s), 1, 2e-6f);
  EXPECT_NEAR(lengthSquared(f.t), 1, 2e-6f);
  EXPECT_NEAR(dot(f.s, f.t), 0, 2e-6f);
  EXPECT_NEAR(dot(f.s, f.n), 0, 2e-6f);
  EXPECT_NEAR(dot(cross(f.s, f.t), f.n), 1, 2e-6f);
}

TEST(Frame, OrthonormalAndRightHanded) {
  Rng rng(1);
  for (int i = 0; i < 10000; ++i) {
    const Vec3f n = sampleSphereUniform(rng.next2D());
    expectOrthonormal(frameFromNormal(n));
    expectOrthonormal(frameFromNormalTangent(n, sampleSphereUniform(rng.next2D()) * 1e-3f));
  }
  expectOrthonormal(frameFromNormal({0, 0, -1}));
  expectOrthonormal(frameFromNormalTangent({0, 0, 1}, {0, 0, 5}));
  expectOrthonormal(frameFromNormalTangent({0, 0, 1}, {0, 0, 0}));
}

TEST(Frame, LocalAndWorldAreInverse) {
  const Frame f = frameFromNormalTangent(normalize(Vec3f(1, 2, 3)), {1, 0, 0});
  const Vec3f v{0.3f, -0.4f, 0.5f};
  EXPECT_NEAR(length(f.toWorld(f.toLocal(v)) - v), 0, 1e-6f);
  EXPECT_NEAR(length(f.toWorld({0, 0, 1}) - f.n), 0, 1e-6f);
}

}  // namespace
}  // namespace lobelia
