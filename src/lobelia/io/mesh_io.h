// Mesh readers: OBJ, PLY, Mitsuba's serialized; and the analytic shapes as meshes.
//
// The readers throw InputError: at `from` when the file cannot be opened, at the place in the file
// when its contents are wrong. What is odd but usable (degenerate triangles, unknown statements,
// zero normals) is added to `findings`. Files without vertex normals get smooth ones, as in Mitsuba,
// unless faceNormals is set or smooth is not. PLY files may be packed with gzip.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

struct MeshOptions {
  bool faceNormals = false;       // drop vertex normals
  bool smooth = true;             // compute vertex normals where the file has none
  std::optional<bool> flipTexCoords;  // v -> 1 - v; empty: Mitsuba's default (OBJ yes, PLY no)
  float maxSmoothAngle = -1;      // degrees: recompute normals, splitting at sharper edges
  int shapeIndex = 0;             // serialized
};
Mesh readObj(const std::string& file, const MeshOptions& options, const Location& from, std::vector<Finding>& findings);
Mesh readPly(const std::string& file, const MeshOptions& options, const Location& from, std::vector<Finding>& findings);
Mesh readSerialized(const std::string& file, const MeshOptions& options, const Location& from, std::vector<Finding>& findings);
void writePly(const std::string& file, const Mesh& mesh);   // binary little endian

// Unit shapes in Mitsuba's parametrisation (uv, normals).
Mesh unitRectangle();   // [-1,1]^2, normal +z
Mesh unitCube();        // [-1,1]^3
Mesh unitDisk();        // radius 1, normal +z
Mesh unitSphere();      // radius 1 at 0; isUnitSphere
Mesh unitCylinder();    // radius 1, from z=0 to z=1, open, normals outward

// Vertex normals from the triangles, weighted by the angle at the vertex. maxSmoothAngle < 0: one
// normal per vertex, as Mitsuba computes them; else vertices are split where the faces of an edge
// (found by position) make a larger angle than this, in degrees.
void computeNormals(Mesh& mesh, float maxSmoothAngle);

}  // namespace lobelia::io
