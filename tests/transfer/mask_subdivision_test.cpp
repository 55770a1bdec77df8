// Meshes are divided where reflections are, without cracks.
#include "lobelia/transfer/mask_subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/base/parallel.h"
#include "relight/cracks.h"
#include "relight/scenes.h"

namespace lobelia::transfer {
namespace {

struct Warnings : Listener {
  int count = 0;
  void message(Severity severity, std::string_view) override {
    count += severity == Severity::warning ? 1 : 0;
  }
  void progress(std::string_view, double) override {}
};

MaskSettings coarse(int rounds) {
  MaskSettings settings;
  settings.level = 5, settings.rounds = rounds;
  return settings;
}

relight::SampleMesh divided(const Scene& scene, const MaskSettings& settings, Context& context) {
  const Tracer tracer(scene, context);
  return subdividedByMasks(tracer, splitMesh(scene), settings, context);
}

size_t countWithin(const relight::SampleMesh& mesh, float inner, float outer) {
  return static_cast<size_t>(std::ranges::count_if(mesh.positions(), [&](Vec3f p) {
    const float r = std::hypot(p.x, p.y);
    return p.z == 0 && r >= inner && r < outer;
  }));
}

TEST(MaskSubdivision, LeavesNoCracks) {
  const Scene scene = test::ballScene(4);
  Context context;
  MaskSettings settings = coarse(3);
  settings.tolerance = 0.02f;  // some triangles of each kind
  const relight::SampleMesh mesh = divided(scene, settings, context);
  ASSERT_GT(context.statistics.count("vertices_added"), 100u);
  EXPECT_GT(context.statistics.count("mask_rays"), 100000u);
  EXPECT_EQ(context.statistics.count("vertices_added"),
            mesh.positions().size() - splitMesh(scene).positions().size());
  test::expectNoCracks(mesh, 4);
  EXPECT_EQ(transferVertices(scene, mesh).size(), mesh.positions().size());
}

TEST(MaskSubdivision, TheFloorAroundAnObjectGetsDense) {
  Scene scene;
  test::place(scene, test::groundMesh(24), scaling({2, 2, 1}));
  test::place(scene, test::sphereMesh(24, 12, true),
              translation({0, 0, 0.16}) * scaling({0.15, 0.15, 0.15}));
  Context context;
  MaskSettings settings = coarse(2);
  settings.tolerance = 0.01f;
  const relight::SampleMesh before = splitMesh(scene), after = divided(scene, settings, context);
  EXPECT_GT(countWithin(after, 0, 0.4f), 10 * countWithin(before, 0, 0.4f));
  EXPECT_EQ(countWithin(after, 1.5f, 9), countWithin(before, 1.5f, 9));
}

TEST(MaskSubdivision, APlaneFarFromAnythingStaysWhole) {
  Scene scene;
  test::place(scene, test::groundMesh(16));  // edges no longer than the scene's eighth
  test::place(scene, test::sphereMesh(8, 4, true),
              translation({0, 0, 6}) * scaling({0.3, 0.3, 0.3}));
  Context context;
  const relight::SampleMesh mesh = divided(scene, coarse(3), context);
  EXPECT_EQ(countWithin(mesh, 0, 9), 17u * 17u);
}

TEST(MaskSubdivision, ABallAloneStaysWhole) {
  Scene scene;
  test::place(scene, test::sphereMesh(32, 16, true));
  Context context;
  EXPECT_EQ(divided(scene, coarse(3), context).positions().size(), 32u * 15 + 2);
}

TEST(MaskSubdivision, LongEdgesAreHalvedFirst) {
  Scene scene;
  test::place(scene, test::groundMesh(1));
  Context context;
  EXPECT_EQ(divided(scene, coarse(0), context).positions().size(), 4u);
  const relight::SampleMesh mesh = divided(scene, coarse(1), context);
  EXPECT_LE(mesh.positions().size(), 17u * 17u);
  const float most = length(Vec3f(2, 2, 0)) / 8;
  for (const relight::LeafTriangle& t : relight::leafTriangles(mesh))
    for (size_t k = 0; k < 3; ++k)
      EXPECT_LE(length(mesh.positions()[t.vertex[k]] - mesh.positions()[t.vertex[(k + 1) % 3]]),
                most * 1.0001f);
}

TEST(MaskSubdivision, AddsNoMoreVerticesThanItMay) {
  const Scene scene = test::ballScene(6);
  const size_t before = splitMesh(scene).positions().size();
  Warnings roomy;
  Context free(&roomy);
  MaskSettings settings = coarse(3);
  settings.level = 4;
  const size_t wanted = divided(scene, settings, free).positions().size();
  EXPECT_EQ(roomy.count, 0);
  ASSERT_GT(wanted, before + 500);
  for (const size_t most : {before, before + 100, wanted - 1}) {
    Warnings warnings;
    Context context(&warnings);
    settings.mostVertices = most;
    const relight::SampleMesh mesh = divided(scene, settings, context);
    EXPECT_LE(mesh.positions().size(), most);
    EXPECT_GE(mesh.positions().size() - before, (most - before) * 8 / 10) << "room is used";
    EXPECT_EQ(warnings.count, 1);
  }
  // The worst edges are halved more than once before all are halved once.
  settings.mostVertices = before + 300;
  Context context;
  const relight::SampleMesh mesh = divided(scene, settings, context);
  float shortest = 1;
  for (const relight::LeafTriangle& t : relight::leafTriangles(mesh))
    if (t.instance == 0)
      for (size_t k = 0; k < 3; ++k)
        shortest = std::min(shortest, length(mesh.positions()[t.vertex[k]] -
                                             mesh.positions()[t.vertex[(k + 1) % 3]]));
  EXPECT_LT(shortest, 2.f / 6 / 3.9f);
}

TEST(MaskSubdivision, MasksWithoutMemoryAreTracedAgain) {
  const Scene scene = test::ballScene(40);
  MaskSettings settings = coarse(1);
  settings.level = 4, settings.tolerance = 0.02f;
  Context roomy, narrow;
  const relight::SampleMesh one = divided(scene, settings, roomy);
  settings.memoryBytes = 0;
  const relight::SampleMesh other = divided(scene, settings, narrow);
  EXPECT_GT(narrow.statistics.count("mask_rays"), roomy.statistics.count("mask_rays"));
  ASSERT_GT(one.positions().size(), splitMesh(scene).positions().size());
  EXPECT_TRUE(std::ranges::equal(one.positions(), other.positions()));
}

TEST(MaskSubdivision, IsTheSameForAnyNumberOfThreads) {
  Context context;
  const relight::SampleMesh many = divided(test::ballScene(6), coarse(2), context);
  const ThreadLimit one(1);
  const relight::SampleMesh single = divided(test::ballScene(6), coarse(2), context);
  EXPECT_TRUE(std::ranges::equal(single.positions(), many.positions()));
}

TEST(MaskSubdivision, StopsWhenCancelled) {
  Context context;
  const Scene scene = test::ballScene(6);
  const Tracer tracer(scene, context);
  context.cancel();
  EXPECT_THROW(subdividedByMasks(tracer, splitMesh(scene), coarse(2), context), Cancelled);
}

}  // namespace
}  // namespace lobelia::transfer
