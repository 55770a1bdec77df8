// Mesh readers: OBJ, PLY, Mitsuba's serialized; and the analytic shapes as meshes.
#pragma once

#include <string>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

struct MeshOptions {
  bool faceNormals = false;       // drop vertex normals
  bool flipTexCoords = true;      // OBJ, PLY: v -> 1 - v, as Mitsuba's default
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
Mesh unitSphere();      // radius 1 at 0
Mesh unitCylinder();    // radius 1, from z=0 to z=1, open, normals outward
void computeNormals(Mesh& mesh, float maxSmoothAngle);

}  // namespace lobelia::io
