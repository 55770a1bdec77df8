// The vertices at which visibility is known, and which of them surround a place of a triangle.
//
// They are the vertices of the scene's instances, welded by their places in the world, and those
// that subdivision added (subdivision.h): the middles of edges, so that a triangle of the scene is
// the root of a small tree of triangles. [P004 section 4.1 has the scene's vertices only]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::relight {

struct SurroundingVertices {
  std::array<uint32_t, 3> vertex;
  std::array<float, 3> weight;  // >= 0, sum to 1
};

// Which vertices make a triangle and how its edges are split. Edge i goes from corner i to the
// next.
struct SampleTriangle {
  std::array<uint32_t, 3> vertex{};
  uint32_t firstChild = 0;  // its children follow one another
  uint32_t splitEdges = 0;  // bit i: edge i is split; 0: no children
};

class SampleMesh {
 public:
  SampleMesh() = default;
  // triangles: first those of instance after instance (firstTriangle: where each instance's begin,
  // and their number at last), then children. Throws std::invalid_argument unless every index is in
  // range and children come after their parents.
  SampleMesh(std::vector<Vec3f> positions, std::vector<SampleTriangle> triangles,
             std::vector<uint32_t> firstTriangle);

  // u, v: barycentric coordinates of the triangle's vertices 1 and 2, as Hit has them.
  SurroundingVertices at(uint32_t instance, uint32_t triangle, float u, float v) const;

  std::span<const Vec3f> positions() const { return positions_; }  // world
  std::span<const SampleTriangle> triangles() const { return triangles_; }
  std::span<const uint32_t> firstTriangle() const { return firstTriangle_; }

 private:
  std::vector<Vec3f> positions_;
  std::vector<SampleTriangle> triangles_;
  std::vector<uint32_t> firstTriangle_;
};

// Of the scene as it is: welded, nothing split.
SampleMesh weldedMesh(const Scene& scene);

// The three corners of each child of a triangle whose edges are split so, as numbers of points: 0
// to 2 the triangle's corners, 3 + i the middle of edge i.
std::span<const std::array<uint8_t, 3>> childCorners(uint32_t splitEdges);

}  // namespace lobelia::relight
