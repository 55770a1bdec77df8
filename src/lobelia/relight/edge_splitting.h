// Halving edges of a mesh without cracks, whoever chooses them.
//
// Edges are known by their two vertices, so that all triangles around one agree on it and no cracks
// come to be. A triangle with two edges to halve halves the third, too, until there are none such
// (red); with one it is cut in two (green). Greens may be cut again, which makes them thin, by one
// step a round; the number of rounds is small.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/relight/vertex_faces.h"

namespace lobelia::relight {

struct MeshEdge {
  uint32_t a = 0, b = 0;              // vertices, a <= b
  size_t firstUse = 0, useCount = 0;  // in EdgeTable::uses
  float error = 0;                    // how much it asks to be halved; 0: not
};

// The edges of all triangles, by their vertices ascending, and who uses them.
struct EdgeTable {
  std::vector<MeshEdge> edges;
  std::vector<uint32_t> uses;   // 3 * triangle + its edge
  std::vector<uint32_t> ofUse;  // the edge, by 3 * triangle + its edge
};
EdgeTable edgesOf(std::span<const LeafTriangle> triangles);

// Makes every edge ask that has to be halved with those that do, so that no triangle keeps just two
// to halve. When more than `room` vertices would be added, only those edges ask any more that need
// it most, the earlier ones of equals: false.
bool closeWithin(EdgeTable* table, size_t room);

// The mesh with its edges halved that ask for it; a closed table of its triangles without children.
SampleMesh halved(const SampleMesh& mesh, std::span<const LeafTriangle> triangles,
                  const EdgeTable& table);

}  // namespace lobelia::relight
