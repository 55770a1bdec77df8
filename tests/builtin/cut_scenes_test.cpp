// The built-in scenes for cuts of visibility [P004], which is kept per vertex: as many vertices as
// the paper's scenes have, evenly spread, and lights of the paper's kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/solids.h"
#include "support/mesh_volume.h"

namespace lobelia {
namespace {

// Different positions, each instance for itself.
uint64_t vertexCount(const Scene& scene) {
  std::vector<uint64_t> counts;
  for (const Mesh& mesh : scene.meshes) {
    std::vector<std::tuple<float, float, float>> places;
    for (const Vec3f p : mesh.positions) places.emplace_back(p.x, p.y, p.z);
    std::sort(places.begin(), places.end());
    counts.push_back(
        static_cast<uint64_t>(std::unique(places.begin(), places.end()) - places.begin()));
  }
  uint64_t sum = 0;
  for (const Instance& instance : scene.instances) sum += counts[instance.mesh.index];
  return sum;
}

float longestEdge(const Mesh& mesh, const Transform& transform) {
  float longest = 0;
  for (const Vec3u t : mesh.triangles)
    for (int c = 0; c < 3; ++c)
      longest = std::max(
          longest, length(transform.vector(mesh.positions[t[(c + 1) % 3]] - mesh.positions[t[c]])));
  return longest;
}

struct CutScene {
  const char* name;
  double vertices;      // of the paper's scene [P004 figure 9]
  float longest;        // edge, in the scene's units
  bool hasEnvironment;  // else lights of its own
};

class EveryCutScene : public testing::TestWithParam<CutScene> {};

void expectSound(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size()) << mesh.name;
  size_t against = 0;
  for (const Vec3u& t : mesh.triangles) {
    const Vec3f n =
        cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    ASSERT_GT(length(n), 0) << mesh.name;
    against += dot(n, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) <= 0;
  }
  // In the creases of a distance field single faces may tip over when it is polygonised.
  EXPECT_LE(against, mesh.triangles.size() / 100) << mesh.name;
}

TEST_P(EveryCutScene, HasThePapersVerticesEvenlyOnSoundMeshes) {
  const Scene scene = builtin::builtinScene(GetParam().name, 1);
  EXPECT_NEAR(static_cast<double>(vertexCount(scene)), GetParam().vertices,
              0.05 * GetParam().vertices);
  for (const Instance& instance : scene.instances)
    EXPECT_LE(longestEdge(scene[instance.mesh], instance.toWorld), GetParam().longest * 1.0001f)
        << instance.name;
  for (const Mesh& mesh : scene.meshes) expectSound(mesh);
}

TEST_P(EveryCutScene, IsLitByTheKindOfLightItIsFor) {
  const Scene scene = builtin::builtinScene(GetParam().name, 0.1f);
  ASSERT_FALSE(scene.emitters.empty());
  for (const Emitter& emitter : scene.emitters)
    EXPECT_EQ(emitter.type == EmitterType::environment, GetParam().hasEnvironment) << emitter.name;
}

constexpr CutScene kScenes[] = {
    {"statue", 68e3, 0.11f, true},   {"machine", 112e3, 0.11f, true},
    {"plants", 114e3, 0.068f, true}, {"teapot-lamp", 86e3, 0.15f, false},
    {"dining", 65e3, 0.37f, false},  {"bedroom", 105e3, 0.16f, false},
};
INSTANTIATE_TEST_SUITE_P(Figure9, EveryCutScene, testing::ValuesIn(kScenes),
                         [](const testing::TestParamInfo<CutScene>& entry) {
                           std::string name = entry.param.name;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(Refine, HalvesEdgesAndKeepsTheSurface) {
  const Mesh coarse = builtin::extrude(builtin::rectangle(1, 0.5f), 0.3f);
  const Mesh fine = builtin::refined(coarse, 0.1f);
  EXPECT_LE(longestEdge(fine, {}), 0.1f);
  EXPECT_GT(longestEdge(fine, {}), 0.05f);
  EXPECT_NEAR(test::volume(fine), test::volume(coarse), 1e-6);
  EXPECT_EQ(fine.normals.size(), fine.positions.size());
  // Faces still meet along their edges: each is used once in each direction, by position.
  using Place = std::tuple<float, float, float>;
  std::multiset<std::pair<Place, Place>> edges;
  const auto place = [&](uint32_t v) {
    const Vec3f p = fine.positions[v];
    return Place{p.x, p.y, p.z};
  };
  for (const Vec3u t : fine.triangles)
    for (int c = 0; c < 3; ++c) edges.insert({place(t[c]), place(t[(c + 1) % 3])});
  for (const auto& [a, b] : edges) {
    EXPECT_EQ(edges.count({a, b}), 1u);
    EXPECT_EQ(edges.count({b, a}), 1u);
  }
  EXPECT_EQ(builtin::refined(coarse, 10).triangles.size(), coarse.triangles.size());
}

TEST(Refine, MeasuresInTheWorld) {
  Scene scene;
  scene.meshes.push_back(builtin::extrude(builtin::rectangle(1, 1), 1));
  Instance large;
  large.mesh = {0};
  large.toWorld = Transform(scaling({1, 3, 1}));
  scene.instances = {Instance{{0}, {}, {}, {}, false, {}}, large};
  builtin::refine(scene, 1);
  EXPECT_LE(longestEdge(scene.meshes[0], large.toWorld), 1);
}

}  // namespace
}  // namespace lobelia
