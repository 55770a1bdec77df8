// Whether a divided mesh of ballScene() holds together.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "lobelia/relight/vertex_faces.h"

namespace lobelia::test {

// No place has two vertices, none lies in the middle of an edge, each edge inside of a surface has
// two triangles, and the ground keeps its area.
inline void expectNoCracks(const relight::SampleMesh& mesh, double groundArea) {
  using Place = std::array<float, 3>;
  const auto key = [](Vec3f p) { return Place{p.x, p.y, p.z}; };
  std::set<Place> places;
  for (const Vec3f p : mesh.positions()) EXPECT_TRUE(places.insert(key(p)).second) << "twice";
  std::map<std::pair<uint32_t, uint32_t>, int> uses;
  std::map<uint32_t, double> areas;
  for (const relight::LeafTriangle& t : relight::leafTriangles(mesh)) {
    const auto p = [&](size_t k) { return mesh.positions()[t.vertex[k]]; };
    areas[t.instance] += 0.5 * double{length(cross(p(1) - p(0), p(2) - p(0)))};
    for (size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t.vertex[k], t.vertex[(k + 1) % 3]);
      ++uses[{a, b}];
      EXPECT_EQ(places.count(key((mesh.positions()[a] + mesh.positions()[b]) * 0.5f)), 0u);
    }
  }
  for (const auto& [edge, count] : uses) {
    const Vec3f a = mesh.positions()[edge.first], b = mesh.positions()[edge.second];
    const bool border = a.z == 0 && b.z == 0 &&
                        ((std::abs(a.x) == 1 && a.x == b.x) || (std::abs(a.y) == 1 && a.y == b.y));
    EXPECT_EQ(count, border ? 1 : 2);
  }
  EXPECT_NEAR(areas[0], groundArea, 1e-5);
}

}  // namespace lobelia::test
