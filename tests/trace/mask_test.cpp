// Stochastic masks: the right share of rays passes, and every kind of query agrees on each ray.
#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/trace/tracer.h"
#include "support/shapes.h"

namespace lobelia {
namespace {

// A masked square (opaque from u = 0.5 on, else `left`), over an opaque one a unit below.
Scene maskedScene(float left, bool instanced) {
  Scene s;
  s.materials.resize(2);
  s.materials[1].type = MaterialType::mask;
  s.materials[1].a = {0};
  s.images.resize(1);
  s.images[0].width = 2, s.images[0].height = 1, s.images[0].channels = 1;
  s.images[0].pixels = {left, 1};
  s.textures.resize(1);
  s.textures[0].type = TextureType::bitmap;
  s.textures[0].image = {0};
  s.textures[0].filter = Filter::nearest;
  s.materials[1].opacity = TextureHandle{0};
  Mesh square = test::squareMesh();
  if (instanced) {  // many triangles in one place, so that copies become Embree instances
    square.positions.insert(square.positions.end(), 3, Vec3f(100.f));
    square.uvs.insert(square.uvs.end(), 3, Vec2f());
    square.triangles.resize(200000, Vec3u(4, 5, 6));
  }
  test::place(s, square, translation({0, 0, 1})).material = {1};
  if (instanced) {
    Instance other = s.instances[0];
    other.toWorld = Transform(translation({50, 0, 0}));
    s.instances.push_back(other);
  }
  test::place(s, test::squareMesh(), translation({-0.5, -0.5, 0}) * scaling({2, 2, 1}));
  return s;
}

class Mask : public testing::TestWithParam<bool> {};

TEST_P(Mask, PassesTheRightShareAndAlwaysAlike) {
  const Scene s = maskedScene(0.3f, GetParam());
  const uint32_t floor = static_cast<uint32_t>(s.instances.size() - 1);
  Context context;
  const Tracer tracer(s, context);
  Rng rng(1);
  int left = 0, stopped = 0;
  for (int i = 0; i < 2000; ++i) {
    ShadowPacket packet{};
    uint32_t expected = 0;
    for (int k = 0; k < ShadowPacket::kSize; ++k) {
      const Vec3f o{0.05f + 0.9f * rng.next1D(), 0.05f + 0.9f * rng.next1D(), 2};
      const Vec3f d = normalize(Vec3f(0.04f * rng.next1D(), 0.04f * rng.next1D(), -1));
      const Ray ray{o, d, 0, 1.5f};  // ends before the floor
      const bool blocked = tracer.occluded(ray);
      EXPECT_EQ(tracer.occluded(ray), blocked);
      const auto hit = tracer.intersect({o, d});
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->instance, blocked ? 0u : floor);
      const float u = o.x + d.x / -d.z;
      if (u < 0.499f) ++left, stopped += blocked ? 1 : 0;
      if (u > 0.501f) {
        EXPECT_TRUE(blocked);
      }
      packet.ox[k] = o.x, packet.oy[k] = o.y, packet.oz[k] = o.z, packet.tMin[k] = 0;
      packet.dx[k] = d.x, packet.dy[k] = d.y, packet.dz[k] = d.z, packet.tMax[k] = 1.5f;
      packet.active[k] = -1;
      if (!blocked) expected |= 1u << k;
    }
    EXPECT_EQ(tracer.visible(packet, i % 2 == 0), expected);
  }
  const double share = static_cast<double>(stopped) / left;
  EXPECT_NEAR(share, 0.3, 4.5 * std::sqrt(0.3 * 0.7 / left));
}

INSTANTIATE_TEST_SUITE_P(Instanced, Mask, testing::Bool());

TEST(Null, IsNeverHit) {
  Scene s = maskedScene(0.f, false);
  s.materials[1].type = MaterialType::null;
  Context context;
  const Tracer tracer(s, context);
  const auto hit = tracer.intersect({{0.75f, 0.5f, 2}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 1u);
  EXPECT_FALSE(tracer.occluded({{0.75f, 0.5f, 2}, {0, 0, -1}, 0, 1.5f}));
}

}  // namespace
}  // namespace lobelia
