// The scene: plain data in vectors, integer handles, no shared ownership.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/base/error.h"
#include "lobelia/scene/camera.h"
#include "lobelia/scene/emitter.h"
#include "lobelia/scene/material.h"
#include "lobelia/scene/mesh.h"

namespace lobelia {

// What a reader or validate() has to say about a scene.
struct Finding {
  Severity severity = Severity::warning;
  Location where;
  std::string message;
};

struct Scene {
  std::string name, file;
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Emitter> emitters;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Camera> cameras;
  std::string integrator;  // hint of the file
  int maxDepth = -1;       // hint of the file; -1: unlimited
  bool hideEmitters = false;
  std::vector<Finding> findings;      // warnings of reading
  std::vector<std::string> variants;  // names of the sets of materials that the file offers

  const Image& operator[](ImageHandle h) const { return images[h.index]; }
  const Texture& operator[](TextureHandle h) const { return textures[h.index]; }
  const Material& operator[](MaterialHandle h) const { return materials[h.index]; }
  const Emitter& operator[](EmitterHandle h) const { return emitters[h.index]; }
  const Mesh& operator[](MeshHandle h) const { return meshes[h.index]; }
};

Bounds3f bounds(const Scene& scene);
uint64_t triangleCount(const Scene& scene);  // instances counted each
// Hash of all that the image depends on (geometry, materials, textures, emitters, cameras).
uint64_t hash(const Scene& scene);
// Everything that is wrong with the scene's data: handles out of range, non-finite vertices,
// degenerate triangles (counted per mesh), singular transforms, albedos above 1, no light at all.
std::vector<Finding> validate(const Scene& scene);

}  // namespace lobelia
