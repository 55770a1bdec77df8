// offsetOrigin(): far enough not to hit the own surface again, near enough not to see past
// contacts.
#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/trace/tracer.h"
#include "support/shapes.h"

namespace lobelia {
namespace {

struct Placement {
  float radius, offset;
  bool instanced;
};

class Sphere : public testing::TestWithParam<Placement> {
 protected:
  Sphere() {
    const auto [radius, offset, instanced] = GetParam();
    centre_ = {offset, -0.7f * offset, 0.3f * offset};
    const Mat4 m = translation({centre_.x, centre_.y, centre_.z}) * rotation({1, 2, 3}, 37) *
                   scaling(Vec3d(radius));
    // Two far copies of a large mesh make Embree instances; a single one is copied.
    Mesh mesh = instanced ? test::sphereMesh(512, 256) : test::sphereMesh(64, 32);
    test::place(scene_, std::move(mesh), m);
    if (!instanced) return;
    Instance other = scene_.instances[0];
    other.toWorld = Transform(translation({0, 0, 1e5}) * m);
    scene_.instances.push_back(other);
  }

  Scene scene_;
  Vec3f centre_;
};

// Leaving a convex surface never hits it again: not with half the error bound either, so the bound
// has a factor of two to spare. Where the sphere is so small against its coordinates that rounding
// its vertices makes dents, only a hit of the very triangle left is wrong.
TEST_P(Sphere, IsNotHitAgain) {
  const auto [radius, offset, instanced] = GetParam();
  Context context;
  const Tracer tracer(scene_, context);
  const float edge = radius * (instanced ? 0.01f : 0.1f);
  const bool dented = 4 * offset * 0x1p-23f > edge * edge / radius * 0.02f;
  Rng rng(1);
  int count = 0, same = 0, any = 0;
  for (int i = 0; i < 30000; ++i) {
    const Vec3f o = centre_ + sampleSphereUniform(rng.next2D()) * (3 * radius);
    const Vec3f target = centre_ + sampleSphereUniform(rng.next2D()) * (0.9f * radius);
    const auto hit = tracer.intersect({o, normalize(target - o)});
    if (!hit) continue;
    const SurfacePoint at = surfacePoint(scene_, *hit);
    Vec3f local = sampleHemisphereCosine(rng.next2D());
    if (i % 2 == 1) local = normalize(Vec3f(local.x, local.y, 0.01f * local.z));  // grazing
    const Vec3f d = frameFromNormal(at.ng).toWorld(local);
    const auto again = tracer.intersect({offsetOrigin(at.p, at.ng, 0.5f * at.error, d), d});
    ++count;
    any += again ? 1 : 0;
    same += again && again->instance == hit->instance && again->triangle == hit->triangle ? 1 : 0;
  }
  EXPECT_GT(count, 25000);
  EXPECT_EQ(same, 0);
  if (!dented) {
    EXPECT_EQ(any, 0);
  }
}

// Going through: a ray that enters does not hit the entry again, and leaves on the other side.
TEST_P(Sphere, TransmittedRaysReachTheFarSide) {
  const auto [radius, offset, instanced] = GetParam();
  if (offset * 1e-4f > radius) GTEST_SKIP() << "rounding leaves no sphere";
  Context context;
  const Tracer tracer(scene_, context);
  Rng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3f o = centre_ + sampleSphereUniform(rng.next2D()) * (3 * radius);
    const auto hit = tracer.intersect({o, normalize(centre_ - o)});
    ASSERT_TRUE(hit);
    const SurfacePoint at = surfacePoint(scene_, *hit);
    const Vec3f d = normalize(centre_ - at.p);
    const auto far = tracer.intersect({offsetOrigin(at, d), d});
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->t, 2 * radius, 0.05f * radius);
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, Sphere,
                         testing::Values(Placement{1e-3f, 0, false}, Placement{1e-3f, 1, false},
                                         Placement{1e-3f, 1e3f, false}, Placement{1, 0, false},
                                         Placement{1, 1, false}, Placement{1, 33.3f, false},
                                         Placement{1, 1e3f, false}, Placement{1e3f, 0, false},
                                         Placement{1e3f, 1e3f, false}, Placement{1, 33.3f, true},
                                         Placement{1e-3f, 1, true}, Placement{1e3f, 1e3f, true}));

class Contact : public testing::TestWithParam<double> {};

// A box on a floor, tilted as a whole, at some distance from the origin. Points of the floor just
// beside the contact look at lights behind the box; all must be blocked, from 10 error bounds on.
TEST_P(Contact, ShadowsStartAtTheContact) {
  const double offset = GetParam();
  for (const double angle : {0., 25.}) {
    const Mat4 m = translation({offset, -0.6 * offset, 0.4 * offset}) * rotation({1, 2, 3}, angle);
    Scene s;
    test::place(s, test::boxMesh({-10, -10, -1}, {10, 10, 0}), m);
    test::place(s, test::boxMesh({0, -5, 0}, {5, 5, 5}), m);
    Context context;
    const Tracer tracer(s, context);
    Rng rng(1);
    int blocked = 0, count = 0;
    for (int i = 0; i < 5000; ++i) {
      const float y = 8 * rng.next1D() - 4;
      const float gap =
          std::max(1e-4f, static_cast<float>(offset) * 2e-5f) * (1 + 9 * rng.next1D());
      const Vec3f above = m.point({-gap, y, 1});
      const auto hit = tracer.intersect({above, m.vector({0, 0, -1})});
      ASSERT_TRUE(hit);
      ASSERT_EQ(hit->instance, 0u);
      const SurfacePoint at = surfacePoint(s, *hit);
      ASSERT_LT(10 * at.error, gap);
      // Low lights behind the box, and points inside it.
      const Vec3f light = m.point({6 + rng.next1D(), y + 0.5f * rng.next1D(), 4 * rng.next1D()});
      const Vec3f o = offsetOrigin(at, light - at.p);
      ++count;
      blocked += tracer.visible(o, light) ? 0 : 1;
    }
    EXPECT_EQ(blocked, count);
  }
}

INSTANTIATE_TEST_SUITE_P(Offsets, Contact, testing::Values(0., 10., 1000.));

// Two surfaces see each other at any distance: the far end is not taken for a blocker.
TEST(Segments, ReachTheFarSurface) {
  for (const float distance : {1e-2f, 1.f, 100.f, 1e4f}) {
    Scene s;
    const Mat4 turn = rotation({1, 2, 3}, 27);
    test::place(s, test::squareMesh(), turn * scaling(Vec3d(distance)));
    test::place(s, test::squareMesh(),
                turn * translation({0, 0, distance}) * rotation({1, 0, 0}, 180) *
                    translation({0, -distance, 0}) * scaling(Vec3d(distance)));
    Context context;
    const Tracer tracer(s, context);
    Rng rng(5);
    for (int i = 0; i < 5000; ++i) {
      SurfacePoint ends[2];
      for (uint32_t k = 0; k < 2; ++k) {
        const Vec2f b = sampleTriangleUniform(rng.next2D());
        ends[k] = surfacePoint(s, {0, b.x, b.y, k, rng.nextUint() % 2});
      }
      const Vec3f d = ends[1].p - ends[0].p;
      ASSERT_TRUE(tracer.visible(offsetOrigin(ends[0], d), offsetOrigin(ends[1], -d)));
    }
  }
}

}  // namespace
}  // namespace lobelia
