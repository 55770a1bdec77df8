// Primitives of meshes as triangle meshes (glTF 2.0, 3.7), with skins and morph targets applied.
#pragma once

#include "lobelia/io/gltf/materials.h"

namespace lobelia::io::gltf {

// What bends a primitive away from its accessors' values.
struct Deformation {
  std::vector<double> weights;  // of morph targets
  std::vector<Mat4> joints;     // mesh to world, when skinned
};

struct Part {
  MeshHandle mesh;
  bool mirrored = false;  // the uv run against the orientation of the surface
};

struct Primitive {
  std::vector<Part> parts;  // none: no triangles
  bool vertexColor = false, vertexAlpha = false;
};

// Adds the primitive's mesh to the scene: two when tangents are needed and some of its triangles
// have mirrored uv.
Primitive addPrimitive(const Import& import, const Materials& materials, const Json& mesh,
                       const Json& primitive, const Deformation& deformation);

}  // namespace lobelia::io::gltf
