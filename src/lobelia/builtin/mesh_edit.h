// What the built-in scenes do to meshes (internal to this room): grids of vertices, moving,
// joining, texture coordinates in metres.
#pragma once

#include <vector>

#include "lobelia/base/transform.h"
#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

inline float fraction(int i, int n) { return static_cast<float>(i) / static_cast<float>(n); }
// cos and sin of the i-th of n parts of the circle; the last is the first, bit for bit.
Vec2f circle(int i, int n);

void addVertex(Mesh& mesh, Vec3f p, Vec3f n, Vec2f uv);
// Two triangles per cell of a grid of (rows + 1) x (columns + 1) vertices that starts at `base`.
// Cells that are pressed into a point at a row's end lose the triangle without area.
void addGrid(Mesh& mesh, size_t base, int rows, int columns);

// Points, normals and, where it mirrors, the triangles' orientation.
Mesh transformed(Mesh mesh, const Mat4& matrix);
Mesh translated(Mesh mesh, Vec3f by);
Mat4 moving(Vec3f by);
// Seen from the other side.
Mesh turnedInsideOut(Mesh mesh);
// One mesh of all; attributes are dropped, normals and uv stay where all have them.
Mesh merged(const std::vector<Mesh>& meshes);
// The largest of the parts that share no vertex, by its number of triangles: a polygonised body
// without what closes hollows inside of it.
Mesh largestPart(const Mesh& mesh);
// Texture coordinates by projection along the axis that each vertex' normal is nearest to, so that
// one texture repeat measures `metres`: on x and z faces u is horizontal and v up, on y faces
// (u, v) = (x, z).
void projectUvs(Mesh& mesh, float metres = 1);
Mesh withProjectedUvs(Mesh mesh, float metres = 1);
// Normals that are smooth up to this angle between faces (io::computeNormals), 0 to 180 degrees.
Mesh creased(Mesh mesh, float degrees);

}  // namespace lobelia::builtin
