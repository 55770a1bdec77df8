// Finer meshes of the same shape (internal to this room).
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

// Edges longer than `longest` (in the mesh's units, above 0) are halved until none is left. Whether
// an edge is halved depends on its ends alone, so that faces that met along an edge still do,
// normals split there or not. Attributes are interpolated linearly: the surface stays where it was.
Mesh refined(Mesh mesh, float longest);

// All meshes of the scene, so that no edge of any instance is longer than `longest` in the world.
// What methods store per vertex and interpolate [P004 section 3.3] then has its places on large
// flat faces, too.
void refine(Scene& scene, float longest);

}  // namespace lobelia::builtin
