// Subdivided meshes have no cracks and vertices where shadows need them.
#include "lobelia/relight/subdivision.h"

#include <gtest/gtest.h>

#include "lobelia/base/parallel.h"
#include "lobelia/relight/vertex_faces.h"
#include "relight/cracks.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

struct Warnings : Listener {
  int count = 0;
  void message(Severity severity, std::string_view) override {
    count += severity == Severity::warning ? 1 : 0;
  }
  void progress(std::string_view, double) override {}
};

SampleMesh divided(const Scene& scene, int rounds, Context& context, size_t allowed = 20000) {
  const Tracer tracer(scene, context);
  const std::vector<uint8_t> bothSides(scene.instances.size(), 0);
  return subdivided(tracer, weldedMesh(scene), environmentSamples(256, 1), bothSides, rounds,
                    context, allowed);
}

TEST(Subdivision, LeavesNoCracks) {
  const Scene scene = test::ballScene(4);
  Context context;
  const SampleMesh mesh = divided(scene, 4, context);
  ASSERT_GT(context.statistics.count("vertices_added"), 20u);
  EXPECT_EQ(context.statistics.count("vertices_added"),
            mesh.positions().size() - weldedMesh(scene).positions().size());
  test::expectNoCracks(mesh, 4);
}

TEST(Subdivision, AddsVerticesWhereTheShadowIs) {
  Context context;
  const SampleMesh mesh = divided(test::ballScene(8), 3, context);
  const size_t before = weldedMesh(test::ballScene(8)).positions().size();
  size_t near = 0, far = 0;
  for (const Vec3f p : mesh.positions().subspan(before))
    (std::abs(p.x) < 0.8f && std::abs(p.y) < 0.8f ? near : far) += 1;
  EXPECT_GT(near, 4 * far);
}

TEST(Subdivision, PlacesOfTheSceneAreFoundInIt) {
  const Scene scene = test::ballScene(4);
  Context context;
  const SampleMesh mesh = divided(scene, 4, context);
  for (int i = 0; i < 100; ++i) {
    const float u = static_cast<float>(i % 10) / 10, v = static_cast<float>(i / 10) / 10 * (1 - u);
    const Hit hit{0, u, v, 0, static_cast<uint32_t>(i) % 32};
    const SurroundingVertices s = mesh.at(0, hit.triangle, u, v);
    Vec3f p;
    for (size_t k = 0; k < 3; ++k) p += mesh.positions()[s.vertex[k]] * s.weight[k];
    EXPECT_LT(length(p - surfacePoint(scene, hit).p), 1e-5f);
  }
}

TEST(Subdivision, LeavesAnOpenPlaneAlone) {
  Scene scene;
  test::place(scene, test::groundMesh(16));  // edges no longer than the scene's eighth
  Context context;
  EXPECT_EQ(divided(scene, 4, context).positions().size(), 17u * 17u);
}

TEST(Subdivision, AddsNoMoreVerticesThanItMay) {
  Scene scene;
  test::place(scene, test::groundMesh(4));
  test::place(scene, test::sphereMesh(8, 4, true),
              translation({0, 0, 0.5}) * scaling({0.3, 0.3, 0.3}));
  const size_t before = weldedMesh(scene).positions().size();
  Warnings roomy;
  Context free(&roomy);
  const size_t wanted = divided(scene, 6, free).positions().size() - before;
  EXPECT_EQ(roomy.count, 0);
  ASSERT_GT(wanted, before + 100);
  for (const size_t allowed : {size_t{0}, before + 7, wanted - 1}) {
    Warnings warnings;
    Context context(&warnings);
    const SampleMesh mesh = divided(scene, 6, context, allowed);
    const size_t most = std::max(before, allowed), added = mesh.positions().size() - before;
    EXPECT_LE(added, most);
    EXPECT_GT(added, most * 8 / 10) << "room is used";
    EXPECT_EQ(warnings.count, 1);
  }
  // With edges that all ask alike: a square whose edges are longer than an eighth of the scene.
  Scene square;
  test::place(square, test::groundMesh(1));
  Warnings warnings;
  Context context(&warnings);
  EXPECT_LE(divided(square, 6, context, 20).positions().size(), 24u);
  EXPECT_EQ(warnings.count, 1);
}

TEST(Subdivision, IsTheSameForAnyNumberOfThreads) {
  Context context;
  const SampleMesh many = divided(test::ballScene(6), 3, context);
  const ThreadLimit one(1);
  const SampleMesh single = divided(test::ballScene(6), 3, context);
  ASSERT_EQ(single.positions().size(), many.positions().size());
  for (size_t v = 0; v < many.positions().size(); ++v)
    ASSERT_EQ(single.positions()[v], many.positions()[v]);
}

}  // namespace
}  // namespace lobelia::relight
