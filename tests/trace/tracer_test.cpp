// Queries against brute force over all triangles, in every way a mesh can be placed.
#include "lobelia/trace/tracer.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "support/shapes.h"

namespace lobelia {
namespace {

// Double-precision Moller-Trumbore over every triangle of every instance.
std::optional<Hit> bruteForce(const Scene& scene, const Ray& ray) {
  std::optional<Hit> best;
  const auto toDouble = [](Vec3f v) { return Vec3d(v.x, v.y, v.z); };
  const Vec3d o = toDouble(ray.o), d = toDouble(ray.d);
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene[instance.mesh];
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec3d p[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = toDouble(instance.toWorld.point(mesh.positions[mesh.triangles[t][k]]));
      }
      const Vec3d e1 = p[1] - p[0], e2 = p[2] - p[0], h = cross(d, e2);
      const double det = dot(e1, h);
      if (det == 0) continue;
      const Vec3d s = o - p[0], q = cross(s, e1);
      const double u = dot(s, h) / det, v = dot(d, q) / det, distance = dot(e2, q) / det;
      if (u < 0 || v < 0 || u + v > 1 || distance <= double{ray.tMin} ||
          distance > (best ? double{best->t} : double{ray.tMax})) {
        continue;
      }
      best = Hit{static_cast<float>(distance), static_cast<float>(u), static_cast<float>(v), i, t};
    }
  }
  return best;
}

// copies: 2 are small enough to be copied; many of a large mesh become Embree instances.
Scene mixedScene(bool instanced) {
  Scene s;
  const uint32_t slices = instanced ? 256 : 16;
  test::place(s, test::boxMesh({-8, -8, -8}, {8, 8, 8}));
  test::place(s, test::sphereMesh(slices, slices / 2), translation({-2, 0, 0}));
  const int copies = instanced ? 5 : 2;
  for (int i = 0; i < copies; ++i) {
    Instance instance = s.instances[1];
    instance.toWorld = Transform(translation({2. * i, 3, -1}) * rotation({1, 2, 3}, 50. * i) *
                                 scaling({1, 0.5, 0.8 + 0.1 * i}));
    s.instances.push_back(instance);
  }
  test::place(s, test::squareMesh(), translation({0, -3, 0}) * scaling({-3, 2, 1}));
  return s;
}

TEST(Tracer, AgreesWithBruteForce) {
  for (const bool instanced : {false, true}) {
    const Scene s = mixedScene(instanced);
    Context context;
    const Tracer tracer(s, context);
    Rng rng(1);
    const int count = instanced ? 100 : 3000;
    for (int i = 0; i < count; ++i) {
      const Vec3f o = sampleSphereUniform(rng.next2D()) * (6 * rng.next1D());
      Ray ray{o, sampleSphereUniform(rng.next2D())};
      if (i % 3 == 1) ray.tMax = 5 * rng.next1D();
      if (i % 3 == 2) ray.tMin = 5 * rng.next1D();
      const auto expected = bruteForce(s, ray), hit = tracer.intersect(ray);
      ASSERT_EQ(expected.has_value(), hit.has_value()) << i;
      EXPECT_EQ(tracer.occluded(ray), hit.has_value());
      if (!hit) continue;
      EXPECT_EQ(hit->instance, expected->instance);
      EXPECT_EQ(hit->triangle, expected->triangle);
      EXPECT_NEAR(hit->t, expected->t, 1e-4f);
      EXPECT_NEAR(hit->b1, expected->b1, 2e-3f);
      const SurfacePoint at = surfacePoint(s, *hit);
      EXPECT_NEAR(length(at.p - (ray.o + ray.d * hit->t)), 0, 1e-4f);
    }
  }
}

TEST(Tracer, PacketsFindTheSameHitsAsSingleRays) {
  for (const bool instanced : {false, true}) {
    const Scene s = mixedScene(instanced);
    Context context;
    const Tracer tracer(s, context);
    Rng rng(3);
    int found = 0, missed = 0;
    for (int k = 0; k < 300; ++k) {
      ShadowPacket packet{};
      std::optional<Hit> expected[ShadowPacket::kSize], hits[ShadowPacket::kSize];
      const int filled = 1 + k % ShadowPacket::kSize;
      for (int i = 0; i < filled; ++i) {
        Ray ray{sampleSphereUniform(rng.next2D()) * 6.f, sampleSphereUniform(rng.next2D())};
        ray.tMax = 10 * rng.next1D();
        if (i == 3) ray.o.x = std::numeric_limits<float>::quiet_NaN();
        packet.set(i, ray);
        expected[i] = tracer.intersect(ray);
        hits[i] = Hit{};  // to be overwritten
      }
      tracer.intersect(packet, k % 2 == 0, hits);
      for (int i = 0; i < ShadowPacket::kSize; ++i) {
        ASSERT_EQ(hits[i].has_value(), expected[i].has_value()) << k << ' ' << i;
        ++(hits[i] ? found : missed);
        if (!hits[i]) continue;
        EXPECT_EQ(hits[i]->instance, expected[i]->instance);
        EXPECT_EQ(hits[i]->triangle, expected[i]->triangle);
        EXPECT_NEAR(hits[i]->t, expected[i]->t, 1e-4f);
        EXPECT_NEAR(hits[i]->b1, expected[i]->b1, 2e-3f);
      }
    }
    EXPECT_GT(found, 200);
    EXPECT_GT(missed, 200);
  }
}

TEST(Tracer, PacketsAgreeWithSingleRays) {
  for (const bool instanced : {false, true}) {
    const Scene s = mixedScene(instanced);
    Context context;
    const Tracer tracer(s, context);
    Rng rng(2);
    uint64_t seen = 0, hidden = 0;
    for (int k = 0; k < 500; ++k) {
      ShadowPacket packet{};
      uint32_t active = 0, expected = 0;
      for (int i = 0; i < ShadowPacket::kSize; ++i) {
        const Vec3f a = sampleSphereUniform(rng.next2D()) * 7.f;
        const Vec3f b = sampleSphereUniform(rng.next2D()) * 7.f;
        packet.set(i, a, b);
        if (rng.next1D() < 0.2f) {
          packet.active[i] = 0;
          continue;
        }
        active |= 1u << i;
        if (tracer.visible(a, b)) expected |= 1u << i;
      }
      EXPECT_EQ(tracer.visible(packet, k % 2 == 0), expected);
      seen += static_cast<uint64_t>(std::popcount(expected));
      hidden += static_cast<uint64_t>(std::popcount(active & ~expected));
    }
    EXPECT_GT(seen, 300u);
    EXPECT_GT(hidden, 300u);
  }
}

TEST(Tracer, ReportsBoundsTimeAndMemory) {
  const Scene s = mixedScene(false);
  Context context;
  const Tracer tracer(s, context);
  EXPECT_EQ(tracer.bounds().lo, Vec3f(-8.f));
  EXPECT_EQ(tracer.bounds().hi, Vec3f(8.f));
  EXPECT_GT(context.statistics.value("embree_bytes"), 1000);
  EXPECT_GT(context.statistics.seconds("accel"), 0);
}

// 16 spheres in the same place: which one is hit must not depend on the threads that built.
TEST(Tracer, SameHitsForAnyThreadCount) {
  Scene s;
  const Mesh sphere = test::sphereMesh(64, 32);
  Mesh stacked;
  for (int k = 0; k < 16; ++k) {
    const auto base = static_cast<uint32_t>(stacked.positions.size());
    for (const Vec3f& p : sphere.positions) stacked.positions.push_back(p);
    for (const Vec3u& t : sphere.triangles) stacked.triangles.push_back(t + Vec3u(base));
  }
  for (int k = 0; k < 3; ++k) test::place(s, stacked);
  std::vector<std::vector<Hit>> hits;
  for (const int threads : {1, 2, 5, 5}) {
    const ThreadLimit limit(threads);
    Context context;
    const Tracer tracer(s, context);
    Rng rng(3);
    hits.emplace_back();
    for (int i = 0; i < 20000; ++i) {
      const auto hit = tracer.intersect({Vec3f(), sampleSphereUniform(rng.next2D())});
      ASSERT_TRUE(hit);
      hits.back().push_back(*hit);
    }
  }
  for (size_t k = 1; k < hits.size(); ++k) {
    for (size_t i = 0; i < hits[k].size(); ++i) {
      ASSERT_EQ(hits[k][i].instance, hits[0][i].instance);
      ASSERT_EQ(hits[k][i].triangle, hits[0][i].triangle);
      ASSERT_EQ(hits[k][i].t, hits[0][i].t);
      ASSERT_EQ(hits[k][i].b1, hits[0][i].b1);
    }
  }
}

TEST(Tracer, RaysWithoutMeaningHitNothing) {
  const Scene s = mixedScene(false);
  Context context;
  const Tracer tracer(s, context);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(tracer.intersect({{nan, 0, 0}, {0, 0, 1}}));
  EXPECT_FALSE(tracer.intersect({{0, 0, 0}, {nan, nan, nan}}));
  EXPECT_FALSE(tracer.intersect({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_FALSE(tracer.intersect({{0, 0, 0}, {0, 0, 1}, 5, 4}));
  EXPECT_FALSE(tracer.intersect({{0, 0, 0}, {0, 0, 1}, 0, nan}));
  EXPECT_FALSE(tracer.intersect({{1e30f, 0, 0}, {-1, 0, 0}}));
  EXPECT_FALSE(tracer.occluded({{nan, 0, 0}, {0, 0, 1}}));
  // Bad lanes of a packet are visible; their neighbours do not suffer, nor do lanes left unset.
  ShadowPacket packet{};
  packet.set(0, {nan, 0, 0}, {0, 0, 20});
  packet.set(1, {0, 0, 0}, {0, 0, 20});
  packet.set(2, {0, 0, 0}, {0, nan, 0});
  packet.set(3, {0, 0, 6}, {0, 0, 7});
  packet.set(4, {nan, nan, nan}, {nan, nan, nan});
  packet.active[4] = 0;
  EXPECT_EQ(tracer.visible(packet, false), 0b1101u);
  EXPECT_EQ(tracer.visible(packet, true), 0b1101u);
  packet.set(3, {0, 0, 6}, {0, 0, 20});
  packet.tMax[3] = -nan;
  EXPECT_EQ(tracer.visible(packet, false), 0b1101u);
}

TEST(Tracer, EmptyAndBrokenScenes) {
  Context context;
  const Scene empty;
  const Tracer tracer(empty, context);
  EXPECT_FALSE(tracer.intersect({{}, {0, 0, 1}}));

  Scene infinite;
  test::place(infinite, test::squareMesh());
  infinite.meshes[0].positions[2].x = std::numeric_limits<float>::quiet_NaN();
  const Tracer survivor(infinite, context);  // Embree leaves such triangles out
  EXPECT_FALSE(survivor.intersect({{0.5f, 0.2f, 1}, {0, 0, -1}}));

  Scene outside;
  outside.file = "broken.xml";
  test::place(outside, test::squareMesh()).name = "card";
  outside.meshes[0].triangles[1].y = 99;
  try {
    const Tracer broken(outside, context);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("broken.xml"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("99"), std::string::npos) << e.what();
  }
  outside = {};
  test::place(outside, test::squareMesh()).mesh = {3};
  EXPECT_THROW(Tracer(outside, context), InputError);
}

TEST(Tracer, BuildingStopsWhenCancelled) {
  const Scene s = mixedScene(true);
  Context context;
  context.cancel();
  EXPECT_THROW(Tracer(s, context), Cancelled);
}

}  // namespace
}  // namespace lobelia
