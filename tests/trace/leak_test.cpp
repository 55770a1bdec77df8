// Closed surfaces hold light back: rays from inside must hit, wherever they go.
#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/trace/tracer.h"
#include "support/shapes.h"

namespace lobelia {
namespace {

struct Misses {
  int single = 0, packet = 0, count = 0;
};

// Rays from the inside straight at points of edges, vertices included. (The fast mode of Embree
// loses several per cent of these.)
Misses shootAtEdges(const Scene& scene, bool vertices) {
  Context context;
  const Tracer tracer(scene, context);
  const Mesh& mesh = scene.meshes[0];
  const Bounds3f box = bounds(scene);
  Rng rng(3);
  Misses misses;
  for (size_t t = 0; t < std::min<size_t>(mesh.triangles.size(), 4000); ++t) {
    for (int e = 0; e < 3; ++e) {
      for (int k = 0; k < 8; ++k) {
        const Vec3f a = mesh.positions[mesh.triangles[t][e]];
        const Vec3f b = mesh.positions[mesh.triangles[t][(e + 1) % 3]];
        const Vec3f p = vertices ? a : lerp(a, b, rng.next1D());
        const Vec3f jitter =
            sampleSphereUniform(rng.next2D()) * (0.3f * minComponent(box.extent()));
        const Vec3f o = box.centre() + (k == 0 ? Vec3f() : jitter * rng.next1D());
        const Ray ray{o, normalize(p - o)};
        ShadowPacket packet{};
        packet.set(0, o, o + ray.d * 10);
        ++misses.count;
        misses.single += tracer.intersect(ray) ? 0 : 1;
        misses.packet += tracer.visible(packet, true) != 0 ? 1 : 0;
      }
    }
  }
  return misses;
}

class Closed : public testing::TestWithParam<double> {};

Mat4 placed(double offset) {
  return translation({offset, 0.3 * offset, -0.5 * offset}) * rotation({1, 2, 3}, 33);
}

TEST_P(Closed, BoxesDoNotLeakAtEdgesAndCorners) {
  for (const Mat4& m : {placed(GetParam()), translation({GetParam(), 0, 1})}) {
    Scene s;
    Mesh box = test::boxMesh({-1, -1, -1}, {1, 1.3f, 0.7f});
    for (Vec3f& p : box.positions) p = m.point(p);
    test::place(s, box);
    for (const bool vertices : {false, true}) {
      const Misses misses = shootAtEdges(s, vertices);
      EXPECT_EQ(misses.single, 0);
      EXPECT_EQ(misses.packet, 0);
    }
  }
}

// Embree's watertight test still loses some rays that run exactly into a vertex where many slim
// triangles meet (its issues 174 and 181): no more than 1 in 50 of those, 1 in 10,000 on edges.
TEST_P(Closed, SpheresHardlyLeak) {
  Scene s;
  Mesh sphere = test::sphereMesh(200, 100);
  for (Vec3f& p : sphere.positions) p = placed(GetParam()).point(p);
  test::place(s, sphere);
  const Misses edges = shootAtEdges(s, false), vertices = shootAtEdges(s, true);
  EXPECT_LE(edges.single, edges.count / 10000);
  EXPECT_LE(edges.packet, edges.count / 10000);
  EXPECT_LE(vertices.single, vertices.count / 50);
}

TEST_P(Closed, RandomRaysDoNotLeak) {
  Scene s;
  Mesh sphere = test::sphereMesh(200, 100);
  for (Vec3f& p : sphere.positions) p = placed(GetParam()).point(p);
  test::place(s, sphere);
  Context context;
  const Tracer tracer(s, context);
  const Vec3f centre = placed(GetParam()).point({});
  Rng rng(7);
  int misses = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3f o = centre + sampleSphereUniform(rng.next2D()) * (0.9f * rng.next1D());
    misses += tracer.intersect({o, sampleSphereUniform(rng.next2D())}) ? 0 : 1;
  }
  EXPECT_EQ(misses, 0);
}

INSTANTIATE_TEST_SUITE_P(Offsets, Closed, testing::Values(0., 10., 1000.));

}  // namespace
}  // namespace lobelia
