#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "io/temporary_folder.h"
#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/io/scene_io.h"
#include "support/mesh_volume.h"

namespace lobelia {
namespace {

Vec3f faceNormal(const Mesh& mesh, const Vec3u& t) {
  return cross(mesh.positions[t.y] - mesh.positions[t.x],
               mesh.positions[t.z] - mesh.positions[t.x]);
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3u& t : mesh.triangles)
    sum += 0.5 * static_cast<double>(length(faceNormal(mesh, t)));
  return sum;
}

using test::volume;

void expectSound(const Mesh& mesh, float leastCosine) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  for (const Vec3u& t : mesh.triangles) {
    const Vec3f n = faceNormal(mesh, t);
    ASSERT_GT(length(n), 0) << mesh.name;
    for (int c = 0; c < 3; ++c)
      ASSERT_GT(dot(n, mesh.normals[t[c]]), leastCosine * length(n)) << mesh.name;
  }
  for (const Vec3f n : mesh.normals) ASSERT_NEAR(length(n), 1, 1e-5f) << mesh.name;
}

// Every edge (by position) is used once in each direction.
bool isClosed(const Mesh& mesh) {
  std::map<std::tuple<float, float, float>, int> ids;
  const auto id = [&](uint32_t v) {
    const Vec3f p = mesh.positions[v] + Vec3f(0.f);  // -0 to 0
    return ids.try_emplace({p.x, p.y, p.z}, static_cast<int>(ids.size())).first->second;
  };
  std::map<std::pair<int, int>, int> edges;
  for (const Vec3u& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) ++edges[{id(t[c]), id(t[(c + 1) % 3])}];
  for (const auto& [edge, count] : edges) {
    const auto twin = edges.find({edge.second, edge.first});
    if (count != 1 || twin == edges.end() || twin->second != 1) return false;
  }
  return true;
}

TEST(BuiltinShapes, RevolvedSphere) {
  const auto profile = [](float t) {
    return Vec2f(t <= 0 || t >= 1 ? 0 : std::sin(kPi * t), -std::cos(kPi * t));
  };
  const Mesh mesh = builtin::revolve(profile, 64, 128);
  expectSound(mesh, 0.99f);
  EXPECT_TRUE(isClosed(mesh));
  EXPECT_NEAR(volume(mesh), 4 * M_PI / 3, 0.01);
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    ASSERT_LT(length(mesh.positions[i] - mesh.normals[i]), 2e-3f);
}

TEST(BuiltinShapes, TorusKnotIsAClosedTube) {
  builtin::TorusKnot knot;
  const Mesh mesh = builtin::torusKnot(knot, 600, 48);
  expectSound(mesh, 0.98f);
  EXPECT_TRUE(isClosed(mesh));
  // By Pappus, area and volume follow from the length of the curve, whatever its shape.
  double length = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * M_PI * i / n, r = static_cast<double>(knot.ring) +
                                           static_cast<double>(knot.wind) * std::cos(3 * t);
    length += std::hypot(2 * r, 3 * static_cast<double>(knot.wind)) * 2 * M_PI / n;
  }
  const auto tube = static_cast<double>(knot.tube);
  EXPECT_NEAR(area(mesh) / (2 * M_PI * tube * length), 1, 0.01);
  EXPECT_NEAR(volume(mesh) / (M_PI * tube * tube * length), 1, 0.01);
}

TEST(BuiltinShapes, RoundedBoxIsClosedAndOfTheRightVolume) {
  const double r = 0.1, x = 1, y = 0.5, z = 0.25;
  const Mesh mesh = builtin::roundedBox({1, 0.5f, 0.25f}, 0.1f, 8);
  expectSound(mesh, 0.99f);
  const double a = 2 * (x - r), b = 2 * (y - r), c = 2 * (z - r);
  // Steiner's formula for the box a b c thickened by r.
  const double expected = a * b * c + 2 * r * (a * b + b * c + c * a) + M_PI * r * r * (a + b + c) +
                          4 * M_PI / 3 * r * r * r;
  EXPECT_NEAR(volume(mesh) / expected, 1, 1e-3);
}

TEST(Cornell, IsAValidSceneAtEveryDetail) {
  size_t previous = 0;
  for (const float detail : {0.05f, 0.25f, 1.f}) {
    const Scene scene = builtin::builtinScene("cornell", detail);
    EXPECT_EQ(scene.name, "cornell");
    for (const Finding& f : validate(scene)) ADD_FAILURE() << f.message;
    const uint64_t count = triangleCount(scene);
    EXPECT_GT(count, previous);
    previous = count;
    std::set<std::string> names;
    for (const Mesh& m : scene.meshes) {
      expectSound(m, detail < 1 ? -1.f : 0.8f);
      EXPECT_FALSE(m.name.empty());
    }
    for (const Instance& i : scene.instances) EXPECT_TRUE(names.insert(i.name).second) << i.name;
    for (const Material& m : scene.materials) EXPECT_FALSE(m.name.empty());
    ASSERT_EQ(scene.cameras.size(), 1u);
  }
  EXPECT_GT(previous, 20000u);
  EXPECT_LT(previous, 60000u);
}

TEST(Cornell, EverythingIsInsideTheRoomAndSeen) {
  const Scene scene = builtin::builtinScene("cornell", 0.5f);
  for (const Instance& instance : scene.instances)
    for (const Vec3f local : scene[instance.mesh].positions) {
      const Vec3f p = instance.toWorld.point(local);
      ASSERT_LE(std::abs(p.x), 1 + 1e-5f) << instance.name;
      ASSERT_LE(std::abs(p.y - 1), 1 + 1e-5f) << instance.name;
      ASSERT_LE(std::abs(p.z), 1 + 1e-5f) << instance.name;
      // In the picture.
      const Vec3f q = scene.cameras[0].toWorld.inverted().point(p);
      ASSERT_LT(std::max(std::abs(q.x), std::abs(q.y)), q.z * std::tan(scene.cameras[0].fovX / 2));
    }
  // The lamp shines down.
  for (const Instance& instance : scene.instances)
    if (instance.emitter.valid()) {
      EXPECT_LT(instance.toWorld.normal({0, 0, 1}).y, 0);
    }
}

TEST(BuiltinScenes, UnknownNamesAndDetailsAreUsageErrors) {
  ASSERT_FALSE(builtin::builtinSceneNames().empty());
  EXPECT_EQ(builtin::builtinSceneNames().front(), "cornell");
  for (const std::string& name : builtin::builtinSceneNames()) {
    const Scene scene = builtin::builtinScene(name, 0.1f);
    EXPECT_TRUE(validate(scene).empty()) << name << ": " << validate(scene)[0].message;
  }
  const std::string message = messageOf<UsageError>([] { builtin::builtinScene("cornel", 1); });
  EXPECT_TRUE(contains(message, "cornell")) << message;
  for (const float detail : {0.f, -1.f, 1e9f, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(builtin::builtinScene("cornell", detail), UsageError);
}

}  // namespace
}  // namespace lobelia
