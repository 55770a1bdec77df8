// What vertices see, against single rays and against what the scene's shapes say.
#include "lobelia/relight/vertex_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "lobelia/base/morton.h"
#include "lobelia/relight/visibility_data.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

// A scene with all that tracing vertices needs; samples in the order they were made, which does for
// these tests.
struct Stage {
  explicit Stage(Scene s, size_t count = 1024,
                 LightSamples::Kind kind = LightSamples::Kind::environment)
      : scene(std::move(s)),
        tracer(scene, context),
        mesh(weldedMesh(scene)),
        triangles(leafTriangles(mesh)),
        samples(kind == LightSamples::Kind::environment ? environmentSamples(count, 1)
                                                        : surfaceSamples(scene, count, 1)) {
    bothSides = bothSidesOf(scene);
    faces.emplace(scene, mesh, triangles, bothSides);
  }
  int levels() const { return std::countr_zero(samples.count()); }
  LeafBits seenFrom(size_t vertex) const {
    LeafBits bits(levels());
    VertexTracer rays(tracer, samples);
    rays.prepare(faces->at(vertex), &bits);
    rays.traceAll(&bits);
    return bits;
  }
  // The vertex nearest to a place.
  size_t vertexAt(Vec3f p) const {
    size_t best = 0;
    for (size_t v = 0; v < mesh.positions().size(); ++v)
      if (length(mesh.positions()[v] - p) < length(mesh.positions()[best] - p)) best = v;
    return best;
  }
  Context context;
  Scene scene;
  Tracer tracer;
  SampleMesh mesh;
  std::vector<LeafTriangle> triangles;
  std::vector<uint8_t> bothSides;
  LightSamples samples;
  std::optional<VertexFaces> faces;
};

// The faces that have to see a sample for the vertex to see it: those that look there of the
// leading ones, or the first of the others.
std::vector<const FacePlace*> looking(const Stage& stage, size_t vertex, size_t sample) {
  std::vector<const FacePlace*> out;
  const auto faces = stage.faces->at(vertex);
  const bool directions = stage.samples.n.empty();
  for (size_t f = 0; f < faces.size(); ++f) {
    const Vec3f d = stage.samples.p[sample] - (directions ? Vec3f(0.f) : faces[f].front);
    if (f >= leadingFaces(faces) && !out.empty()) break;
    if (dot(faces[f].n, d) > 0 && (directions || dot(stage.samples.n[sample], d) < 0))
      out.push_back(&faces[f]);
  }
  return out;
}

bool get(const std::vector<uint64_t>& bits, size_t leaf) {
  return (bits[leaf / 64] >> (leaf % 64) & 1) != 0;
}

TEST(VertexVisibility, IsThatOfSingleRays) {
  const Stage stage(test::ballScene(6));
  for (size_t v = 0; v < stage.mesh.positions().size(); v += 7) {
    const LeafBits bits = stage.seenFrom(v);
    for (size_t i = 0; i < stage.samples.count(); ++i) {
      const Vec3f d = stage.samples.p[i];
      const auto faces = looking(stage, v, i);
      ASSERT_EQ(get(bits.matters, i), !faces.empty());
      const bool visible = std::none_of(faces.begin(), faces.end(), [&](const FacePlace* f) {
        return stage.tracer.occluded({f->front, d, 0, 1e30f});
      });
      EXPECT_EQ(get(bits.visible, i), visible && !faces.empty());
    }
  }
}

// The ball's shadow: a direction is blocked if its line from the vertex meets the ball.
TEST(VertexVisibility, OfTheGroundUnderABall) {
  const Stage stage(test::ballScene(12));
  for (const Vec3f place : {Vec3f{0, 0, 0}, Vec3f{0.5f, 0, 0}, Vec3f{1, -1, 0}}) {
    const size_t vertex = stage.vertexAt(place);
    const LeafBits bits = stage.seenFrom(vertex);
    for (size_t i = 0; i < stage.samples.count(); ++i) {
      const Vec3f d = stage.samples.p[i];
      if (std::abs(d.z) < 0.02f) continue;
      EXPECT_EQ(get(bits.matters, i), d.z > 0);
      if (d.z < 0) continue;
      const Vec3f toBall = Vec3f{0, 0, 0.5f} - place;
      const float distance = length(toBall - d * dot(toBall, d));
      // The ball is made of triangles, and rays start a little way from the vertex.
      if (std::abs(distance - 0.3f) > 0.03f) {
        EXPECT_EQ(get(bits.visible, i), distance > 0.3f) << i;
      }
    }
  }
}

TEST(VertexVisibility, DoesNotLeakThroughThinWalls) {
  const Stage stage(test::boxScene(false));  // one-sided quads without thickness
  for (size_t v = 0; v < stage.mesh.positions().size(); ++v) {
    const LeafBits bits = stage.seenFrom(v);
    for (size_t w = 0; w < bits.wordCount(); ++w) EXPECT_EQ(bits.visible[w], 0u) << v;
  }
}

// At the foot of a box, which stands on the ground or is sunk into it a little: along the ground
// light comes from outside, none from below it.
TEST(VertexVisibility, AtTheFootOfABox) {
  for (const float foot : {0.f, -0.001f, 0.001f}) {
    Scene scene;
    test::place(scene, test::groundMesh(4));
    test::place(scene, test::boxMesh({-0.3f, -0.3f, foot}, {0.3f, 0.3f, 0.5f}));
    const Stage stage(std::move(scene));
    const LeafBits bits = stage.seenFrom(stage.vertexAt({0.3f, 0.3f, foot}));
    for (size_t i = 0; i < stage.samples.count(); ++i) {
      const Vec3f d = stage.samples.p[i];
      if (minComponent(Vec3f{std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < 0.1f) continue;
      // Directions straight below matter to the box's lower side alone.
      if (d.x < 0 && d.y < 0) continue;
      EXPECT_TRUE(get(bits.matters, i));
      EXPECT_EQ(get(bits.visible, i), d.z > 0) << foot << ": " << d.x << " " << d.y << " " << d.z;
    }
  }
}

TEST(VertexVisibility, OfTwoSidedSheetsMattersEverywhere) {
  Scene scene;
  test::place(scene, test::groundMesh(2)).material = test::addTwoSided(scene);
  test::place(scene, test::groundMesh(1), translation({0, 0, -0.5}));
  const Stage stage(std::move(scene));
  const LeafBits bits = stage.seenFrom(stage.vertexAt({0, 0, 0}));
  for (size_t i = 0; i < stage.samples.count(); ++i) {
    const Vec3f d = stage.samples.p[i];
    if (std::abs(d.z) < 0.01f) continue;
    EXPECT_TRUE(get(bits.matters, i));
    const Vec3f below = d * (0.5f / std::max(-d.z, 1e-6f));  // where it meets the lower sheet
    if (d.z > 0) {
      EXPECT_TRUE(get(bits.visible, i));
    } else if (std::abs(std::max(std::abs(below.x), std::abs(below.y)) - 1) > 0.1f) {
      EXPECT_EQ(get(bits.visible, i), std::max(std::abs(below.x), std::abs(below.y)) > 1);
    }
  }
}

TEST(VertexVisibility, OfSurfacesNeedsThemToFaceEachOther) {
  const Stage stage(test::ballScene(6), 512, LightSamples::Kind::surfaces);
  size_t visible = 0;
  for (size_t v = 0; v < stage.mesh.positions().size(); v += 5) {
    const LeafBits bits = stage.seenFrom(v);
    for (size_t i = 0; i < stage.samples.count(); ++i) {
      const auto faces = looking(stage, v, i);
      ASSERT_EQ(get(bits.matters, i), !faces.empty());
      if (faces.empty()) continue;
      EXPECT_EQ(get(bits.visible, i),
                std::all_of(faces.begin(), faces.end(), [&](const FacePlace* f) {
                  return stage.tracer.visible(f->front, stage.samples.p[i]);
                }));
      visible += get(bits.visible, i) ? 1 : 0;
    }
  }
  EXPECT_GT(visible, 100u) << "the ball's lower half and the ground see each other";
}

TEST(VertexVisibility, AdaptiveTracingMissesNextToNothing) {
  const Stage stage(test::ballScene(12), 4096);
  const LightSamples ordered =
      reordered(stage.samples, [&] {  // by direction, so that nodes are clusters
        std::vector<uint32_t> order(stage.samples.count());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto key = [&](uint32_t i) {
          const Vec3f p = stage.samples.p[i];
          return morton(Vec3f{p.x, p.y, p.z} * 0.5f + Vec3f(0.5f));
        };
        std::sort(order.begin(), order.end(),
                  [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
        return order;
      }());
  const SampleNeighbours neighbours(ordered);
  const VertexNeighbours around(stage.mesh.positions().size(), stage.triangles);
  VertexTracer few(stage.tracer, ordered, &neighbours), all(stage.tracer, ordered);
  const size_t count = 13 * 13;  // of the ground
  std::vector<LeafBits> bits(count, LeafBits(stage.levels()));
  uint64_t wrong = 0, values = 0;
  for (size_t v = 0; v < count; ++v) {
    std::vector<const LeafBits*> nearby;
    for (const uint32_t other : around.at(v))
      if (other < v) nearby.push_back(&bits[other]);
    few.prepare(stage.faces->at(v), &bits[v]);
    few.traceAdaptively(nearby, v, &bits[v]);
    LeafBits truth(stage.levels());
    all.prepare(stage.faces->at(v), &truth);
    all.traceAll(&truth);
    EXPECT_EQ(truth.matters, bits[v].matters);
    for (size_t w = 0; w < truth.wordCount(); ++w) {
      EXPECT_EQ(bits[v].visible[w] & ~bits[v].matters[w], 0u);
      wrong += static_cast<uint64_t>(std::popcount(truth.visible[w] ^ bits[v].visible[w]));
      values += static_cast<uint64_t>(std::popcount(truth.matters[w]));
    }
  }
  EXPECT_EQ(all.rays(), values);
  EXPECT_LT(few.rays(), values / 2);
  EXPECT_LT(static_cast<double>(wrong), 1e-3 * static_cast<double>(values));
}

TEST(SampleNeighbours, AreAboutSix) {
  const LightSamples samples = environmentSamples(1024, 1);
  const SampleNeighbours neighbours(samples);
  size_t sum = 0;
  for (size_t i = 0; i < samples.count(); ++i) {
    EXPECT_GE(neighbours.at(i).size(), 3u);
    for (const uint16_t j : neighbours.at(i)) {
      EXPECT_NE(j, i);
      EXPECT_LT(length(samples.p[i] - samples.p[j]), 0.2f);
    }
    sum += neighbours.at(i).size();
  }
  EXPECT_NEAR(static_cast<double>(sum) / 1024, 6, 1);
}

TEST(SampleNeighbours, AreFewWhereSheetsAreStacked) {
  Scene scene;
  for (int i = 0; i < 200; ++i)
    test::place(scene, test::squareMesh(), translation({0, 0, 1e-4 * i}));
  const LightSamples samples = surfaceSamples(scene, 2048, 1);
  const SampleNeighbours neighbours(samples);
  for (size_t i = 0; i < samples.count(); ++i)
    EXPECT_LE(neighbours.at(i).size(), SampleNeighbours::kMost);
}

}  // namespace
}  // namespace lobelia::relight
