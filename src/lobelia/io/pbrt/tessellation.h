// PBRT's curved shapes as meshes in object space, with its parametrisation.
#pragma once

#include "lobelia/scene/mesh.h"

namespace lobelia::io::pbrt {

constexpr float kFullTurn = 360;

struct SphereShape {
  float radius = 1, zMin = -1, zMax = 1, phiMax = kFullTurn;  // degrees
};
struct DiskShape {
  float height = 0, radius = 1, innerRadius = 0, phiMax = kFullTurn;
};
struct CylinderShape {
  float radius = 1, zMin = -1, zMax = 1, phiMax = kFullTurn;
};

Mesh tessellateSphere(const SphereShape& shape);
// The whole sphere of radius 1; isUnitSphere.
Mesh wholeUnitSphere();
Mesh tessellateDisk(const DiskShape& shape);
Mesh tessellateCylinder(const CylinderShape& shape);

// Bilinear patches, four corners p00, p10, p01, p11 by index each. normals and uvs: per vertex or
// empty (the patch's own coordinates then). Indices must be in range, their number a multiple of 4.
Mesh tessellatePatches(const std::vector<Vec3f>& positions, const std::vector<uint32_t>& indices,
                       const std::vector<Vec3f>& normals, const std::vector<Vec2f>& uvs);

// Loop's subdivision surface (Loop 1987) of a closed or open triangle mesh after `levels` steps,
// its vertices moved to the limit surface.
Mesh subdivideLoop(const Mesh& control, int levels);

}  // namespace lobelia::io::pbrt
