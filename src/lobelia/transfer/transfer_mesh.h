// The vertices at which transfer is known: those of the scene and those that subdivision added,
// one for each way to reflect light at a place. Where smoothing groups, materials or, for textured
// materials, texture coordinates meet, a place has several.
#pragma once

#include <vector>

#include "lobelia/relight/sample_mesh.h"
#include "lobelia/scene/shading.h"

namespace lobelia::transfer {

// A place of a triangle of the scene, of which surfacePoint() makes the vertex's frame and
// material.
struct TransferVertex {
  uint32_t instance = 0, triangle = 0;
  float b1 = 0, b2 = 0;  // barycentrics of the triangle's vertices 1 and 2
  Vec3f p{};             // world
  Vec3f n{0, 0, 1};      // unit shading normal, outside
  Hit hit() const { return {0, b1, b2, instance, triangle}; }
};

struct TransferMesh {
  relight::SampleMesh mesh;              // its positions are those of vertices
  std::vector<TransferVertex> vertices;  // by the mesh's number
  // By vertex: is it inside of another object (buried_vertices.h)? Empty: none is.
  std::vector<uint8_t> buried{};

  // The vertices around a place, and their weights. Buried ones have none unless all are: between
  // bodies that go through one another what is known outside holds up to where they meet.
  relight::SurroundingVertices around(const Hit& hit) const;
};

// Of the scene as it is, nothing split. Corners of one place are one vertex where their materials
// are the same, their shading normals differ by less than a thousandth and, if the material has
// textures, their texture coordinates do, too, and attributes not at all; where it depends on
// tangents (anisotropic ones, normal maps), if these are less than about 11 degrees apart.
relight::SampleMesh splitMesh(const Scene& scene);
// The vertices of a mesh made from the scene by splitMesh() and subdivision; each a corner of its
// largest triangle.
std::vector<TransferVertex> transferVertices(const Scene& scene, const relight::SampleMesh& mesh);
// Is anything of the material, or of what it wraps, driven by a texture (bump and normal maps
// included)?
bool isTextured(const Scene& scene, MaterialHandle material);

}  // namespace lobelia::transfer
