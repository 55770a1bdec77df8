// Masks say what rays say, by few of them.
#include "lobelia/transfer/visibility_mask.h"

#include <gtest/gtest.h>

#include <bit>

#include "lobelia/base/random.h"
#include "lobelia/transfer/transfer_mesh.h"
#include "relight/scenes.h"

namespace lobelia::transfer {
namespace {

using relight::LeafBits;

bool at(const std::vector<uint64_t>& words, size_t i) {
  return (words[i / 64] >> (i % 64) & 1) != 0;
}

// A scene with all its vertices' faces.
struct Vertices {
  explicit Vertices(const Scene& s)
      : scene(s),
        tracer(scene, context),
        mesh(splitMesh(scene)),
        bothSides(scene.instances.size(), 0),
        faces(scene, mesh, relight::leafTriangles(mesh), bothSides) {}
  Context context;
  Scene scene;
  Tracer tracer;
  relight::SampleMesh mesh;
  std::vector<uint8_t> bothSides;
  relight::VertexFaces faces;
};

TEST(PackedMask, GivesBackWhatWasPacked) {
  LeafBits bits, back;
  for (LeafBits* b : {&bits, &back})
    for (auto* words : {&b->visible, &b->matters}) words->assign(4097, 0);
  Rng rng(3);
  for (const double rate : {0.0, 1e-5, 1e-3, 0.05, 0.5}) {
    for (auto* words : {&bits.visible, &bits.matters}) {
      bool one = rng.next1D() < 0.5f;
      for (size_t i = 0; i < 64 * words->size(); ++i) {
        if (double{rng.next1D()} < rate) one = !one;
        uint64_t& word = (*words)[i / 64];
        word = (word & ~(uint64_t{1} << (i % 64))) | uint64_t{one} << (i % 64);
      }
    }
    const PackedMask packed(bits);
    EXPECT_FALSE(packed.empty());
    packed.unpack(&back);
    EXPECT_EQ(back.visible, bits.visible);
    EXPECT_EQ(back.matters, bits.matters);
    if (rate < 1e-4) {
      EXPECT_LT(packed.byteCount(), 300u);
    }
  }
  bits.visible.assign(4097, ~uint64_t{0}), bits.matters.assign(4097, 0);
  PackedMask(bits).unpack(&back);
  EXPECT_EQ(back.visible, bits.visible);
  EXPECT_EQ(back.matters, bits.matters);
}

TEST(MaskTracer, SaysWhatRaysSay) {
  const Vertices s(test::ballScene(4));
  const MaskDirections directions(4);
  MaskTracer masks(s.tracer, directions);
  const std::array<size_t, 3> vertices{0, 7, 12};  // of the ground, the last one under the ball
  for (const size_t v : vertices) {
    const LeafBits& bits = masks.traceAll(s.faces.at(v));
    const Vec3f p = s.mesh.positions()[v];
    size_t wrong = 0, open = 0;
    for (size_t i = 0; i < directions.count(); ++i) {
      const Vec3f d = directions.grid().directions()[i];
      EXPECT_EQ(at(bits.matters, i), d.z > 0);
      if (d.z <= 0) continue;
      const bool visible = !s.tracer.occluded({p + Vec3f(0, 0, 1e-4f), d, 0, 1e30f});
      open += visible ? 1 : 0;
      wrong += at(bits.visible, i) != visible ? 1 : 0;
    }
    EXPECT_GT(open, 800u);
    EXPECT_LE(wrong, 30u) << "rays start a little inside of a face";
  }
  EXPECT_LT(masks.rays(), 3u * directions.count());
}

TEST(MaskTracer, FewRaysFindNearlyAllThatAllRaysFind) {
  Scene scene = test::ballScene(4);
  test::place(scene, test::boxMesh({0.3f, -0.6f, 0}, {0.7f, -0.2f, 0.5f}));
  test::place(scene, test::boxMesh({-0.7f, -0.4f, 0.2f}, {-0.3f, 0.4f, 0.21f}));  // thin
  const Vertices s(scene);
  const MaskDirections directions(7);
  MaskTracer few(s.tracer, directions), all(s.tracer, directions);
  size_t wrong = 0, count = 0;
  for (size_t v = 0; v < s.mesh.positions().size(); v += 11, ++count) {
    const LeafBits &some = few.trace(s.faces.at(v)), &every = all.traceAll(s.faces.at(v));
    ASSERT_EQ(some.matters, every.matters);
    size_t here = 0;
    for (size_t w = 0; w < some.wordCount(); ++w) {
      EXPECT_EQ(some.visible[w] & ~some.matters[w], 0u);
      here += static_cast<size_t>(std::popcount(some.visible[w] ^ every.visible[w]));
    }
    EXPECT_LT(here, directions.count() / 1000) << v;
    wrong += here;
  }
  EXPECT_LT(wrong, count * directions.count() / 20000);  // measured: .001 % on the built-in scenes
  EXPECT_LT(8 * few.rays(), all.rays());
}

TEST(MaskTracer, ABallDoesNotHideTheSkyFromItself) {
  Scene scene;
  test::place(scene, test::sphereMesh(16, 8, true));
  const Vertices s(scene);
  const MaskDirections directions(6);
  MaskTracer masks(s.tracer, directions);
  for (size_t v = 0; v < s.mesh.positions().size(); ++v) {
    const LeafBits& bits = masks.trace(s.faces.at(v));
    EXPECT_EQ(bits.visible, bits.matters);
  }
}

}  // namespace
}  // namespace lobelia::transfer
