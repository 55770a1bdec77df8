// The triangles around each vertex and the places from which they see.
//
// A ray that starts at a vertex can not tell the faces around it from others near by, and there is
// no place off the surface that suits all of them: at the foot of a box one face looks along the
// floor, at a room's edge a place behind the wall must not see the sky. Rays therefore start inside
// of the faces, a little way from the vertex towards a face's middle, where the scene's own offset
// keeps them off the surface (scene/shading.h).
//
// What a vertex sees in a direction is what a face that looks there sees. Where edges are sharp,
// faces can differ: the lower side of a box that stands on a plane, or is sunk into it, looks out
// below it. There all have to see a direction. (The paper does not say how its rays start.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/relight/light_samples.h"
#include "lobelia/relight/sample_mesh.h"

namespace lobelia::relight {

// A triangle without children, and where its corners are in the scene's triangle (barycentrics of
// its vertices 1 and 2).
struct LeafTriangle {
  std::array<uint32_t, 3> vertex{};
  uint32_t instance = 0, triangle = 0;
  std::array<Vec2f, 3> corner;
  uint32_t index = 0;  // of SampleMesh::triangles()
};
std::vector<LeafTriangle> leafTriangles(const SampleMesh& mesh);

struct FacePlace {
  Vec3f front, back;  // off the surface to the side of n, and to the other
  Vec3f n;            // unit, as SurfacePoint::ng
  bool bothSides = false;
};
// A little inside of a triangle without children from the place that its corners' weights say (sum
// 1).
FacePlace facePlace(const Scene& scene, const LeafTriangle& triangle, const Vec3f& weights,
                    bool bothSides);

class VertexFaces {
 public:
  // bothSides: by instance (VisibilityData).
  VertexFaces(const Scene& scene, const SampleMesh& mesh, std::span<const LeafTriangle> triangles,
              std::span<const uint8_t> bothSides);
  // The first is the one that has most of the others' directions in front of it. None: all
  // triangles around the vertex are degenerate.
  std::span<const FacePlace> at(size_t vertex) const {
    return {faces_.data() + begin_[vertex], faces_.data() + begin_[vertex + 1]};
  }

 private:
  std::vector<FacePlace> faces_;
  std::vector<uint32_t> begin_;
};

// How many of the faces around a vertex, the first ones, stand for all directions that these look
// in: the one nearest to the mean of normals, then such as are turned away from those before by
// more than 45 degrees, at most 8.
size_t leadingFaces(std::span<const FacePlace> faces);

// Vertices that share an edge with each vertex, ascending.
class VertexNeighbours {
 public:
  VertexNeighbours(size_t vertexCount, std::span<const LeafTriangle> triangles);
  std::span<const uint32_t> at(size_t vertex) const {
    return {others_.data() + begin_[vertex], others_.data() + begin_[vertex + 1]};
  }

 private:
  std::vector<uint32_t> others_;
  std::vector<size_t> begin_;
};

}  // namespace lobelia::relight
