// What every mesh reader does with a mesh that it has filled (internal to io).
#pragma once

#include <string>
#include <vector>

#include "lobelia/io/mesh_io.h"

namespace lobelia::io {

// Checks and completes a mesh read from `file`:
//  - indices out of range and non-finite positions, normals, uvs: InputError that names the
//  element;
//  - normals are made unit (left as they are when they already are, so that writing and reading
//    again gives the same bits); zero normals, a sign of missing ones, are replaced by computed
//    ones;
//  - normals are dropped (faceNormals) or computed (none, or maxSmoothAngle >= 0);
//  - degenerate triangles are kept, counted in a finding.
void finishMesh(Mesh& mesh, const std::string& file, const MeshOptions& options,
                std::vector<Finding>& findings);

void addWarning(std::vector<Finding>& findings, const Location& where, const std::string& message);

}  // namespace lobelia::io
