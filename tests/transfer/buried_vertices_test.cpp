#include "lobelia/transfer/buried_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/relight/visibility_data.h"
#include "small_transfer.h"

namespace lobelia::transfer {
namespace {

// By vertex, of the instance asked for.
struct Buried {
  TransferMesh mesh;
  size_t count(uint32_t instance) const {
    size_t sum = 0;
    for (size_t v = 0; v < mesh.vertices.size(); ++v)
      sum += mesh.vertices[v].instance == instance && mesh.buried[v] != 0 ? 1 : 0;
    return sum;
  }
};

Buried buriedOf(const Scene& scene) {
  Context context;
  const Tracer tracer(scene, context);
  Buried out;
  out.mesh.mesh = splitMesh(scene);
  out.mesh.vertices = transferVertices(scene, out.mesh.mesh);
  const std::vector<uint8_t> bothSides = relight::bothSidesOf(scene);
  const relight::VertexFaces faces(scene, out.mesh.mesh, relight::leafTriangles(out.mesh.mesh),
                                   bothSides);
  out.mesh.buried = buriedVertices(tracer, out.mesh, faces, bothSides, context);
  EXPECT_EQ(context.statistics.count("vertices_buried"),
            static_cast<uint64_t>(std::count(out.mesh.buried.begin(), out.mesh.buried.end(), 1)));
  return out;
}

Mesh ball() { return test::sphereMesh(12, 8, true); }
Mesh hollow() {
  Mesh mesh = ball();
  for (Vec3u& t : mesh.triangles) std::swap(t.y, t.z);
  for (Vec3f& n : mesh.normals) n = -n;
  return mesh;
}

// A small ball stuck into a large one.
Scene twoBalls() {
  Scene scene;
  test::place(scene, ball());
  test::place(scene, ball(), translation({1, 0, 0}) * scaling({0.4, 0.4, 0.4}));
  return scene;
}

TEST(BuriedVertices, AreThoseInsideOfAnotherBody) {
  const Buried found = buriedOf(twoBalls());
  for (size_t v = 0; v < found.mesh.vertices.size(); ++v) {
    const TransferVertex& vertex = found.mesh.vertices[v];
    const Vec3f centre = vertex.instance == 0 ? Vec3f(1, 0, 0) : Vec3f(0, 0, 0);
    const float inside = length(vertex.p - centre) / (vertex.instance == 0 ? 0.4f : 1.f);
    if (std::abs(inside - 1) > 0.12f) {  // the balls have corners
      EXPECT_EQ(found.mesh.buried[v] != 0, inside < 1) << v;
    }
  }
  EXPECT_GT(found.count(1), 10u);
}

TEST(BuriedVertices, RoomsContactsAndTwoSidedBodiesHaveNone) {
  Scene room;
  test::place(room, hollow());
  test::place(room, ball(), scaling({0.3, 0.3, 0.3}));
  EXPECT_EQ(buriedOf(room).count(0) + buriedOf(room).count(1), 0u);

  Scene standing;  // on the ground, which it touches
  test::place(standing, test::groundMesh(6));
  test::place(standing, ball(), translation({0, 0, 0.3}) * scaling({0.3, 0.3, 0.3}));
  EXPECT_EQ(buriedOf(standing).count(0) + buriedOf(standing).count(1), 0u);

  Scene twoSided = twoBalls();
  const MaterialHandle material = test::addTwoSided(twoSided);
  for (Instance& instance : twoSided.instances) instance.material = material;
  EXPECT_EQ(buriedOf(twoSided).count(0) + buriedOf(twoSided).count(1), 0u);
}

TEST(BuriedVertices, HaveNoWeightUnlessAllAre) {
  Buried found = buriedOf(twoBalls());
  TransferMesh& mesh = found.mesh;
  const Hit hit{0, 0.25f, 0.25f, 1, 0};
  mesh.buried.assign(mesh.vertices.size(), 0);
  const relight::SurroundingVertices plain = mesh.around(hit);
  mesh.buried[plain.vertex[0]] = 1;
  const relight::SurroundingVertices without = mesh.around(hit);
  EXPECT_EQ(without.weight[0], 0);
  EXPECT_NEAR(without.weight[1], plain.weight[1] / (plain.weight[1] + plain.weight[2]), 1e-6f);
  EXPECT_NEAR(without.weight[1] + without.weight[2], 1, 1e-6f);
  for (const uint32_t v : plain.vertex) mesh.buried[v] = 1;
  EXPECT_EQ(mesh.around(hit).weight, plain.weight);
}

}  // namespace
}  // namespace lobelia::transfer
