// The sides of vertices whose diffuse light is kept. What arrives in front of a surface and behind
// it has nothing in common; yet few scenes have surfaces that are diffuse on both sides, and others
// are not to grow for them.
//
// Deviation: [P002] has surfaces with a front alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/transfer/transfer_mesh.h"

namespace lobelia::transfer {

// Of a surface; the front is that of the outside's normal. It is a place's, which its geometric
// normal tells: around a silhouette the normals of the vertices next to it look both ways.
enum class Side : uint8_t { front, back };

// How they are numbered: vertex after vertex, of each its front and then, if it has one, its back.
class DiffuseSides {
 public:
  static constexpr size_t kNone = ~size_t{0};

  // Fronts alone, of any number of vertices.
  DiffuseSides() = default;
  // backs: the vertices that have one. Throws std::invalid_argument unless they ascend and are
  // below vertexCount.
  DiffuseSides(size_t vertexCount, std::span<const uint32_t> backs);

  // The front's number; of the number of all vertices: how many sides these have.
  size_t front(size_t vertex) const { return before_.empty() ? vertex : vertex + before_[vertex]; }
  bool hasBack(size_t vertex) const {
    return !before_.empty() && before_[vertex + 1] > before_[vertex];
  }
  // kNone: nothing is kept of it.
  size_t find(size_t vertex, Side side) const {
    if (side == Side::front) return front(vertex);
    return hasBack(vertex) ? front(vertex) + 1 : kNone;
  }
  std::vector<uint32_t> backs() const;  // as the constructor has them
  size_t byteCount() const { return before_.size() * sizeof(uint32_t); }

 private:
  std::vector<uint32_t> before_;  // by vertex, and the end: backs of those before it. Empty: none
};

// Of a mesh's vertices: has any side of any of them diffuse lobes, and which have them behind? For
// textured materials at the vertex itself.
struct DiffuseVertices {
  bool any = false;
  std::vector<uint32_t> backs;  // ascending
};
DiffuseVertices findDiffuse(const Scene& scene, std::span<const TransferVertex> vertices);

}  // namespace lobelia::transfer
