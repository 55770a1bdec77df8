// OBJ files with their materials (internal to io).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/io/mesh_io.h"

namespace lobelia::io {

struct ObjMesh {
  static constexpr uint32_t kNoMaterial = 0xffffffffu;
  Mesh mesh;
  std::vector<uint32_t> triangleMaterials;  // index in `materials`, or kNoMaterial
  std::vector<std::string> materials;       // names after usemtl, in order of first use
  std::vector<std::string> libraries;       // files after mtllib, as written
};
ObjMesh readObjWithMaterials(const std::string& file, const MeshOptions& options,
                             const Location& from, std::vector<Finding>& findings);

// A material of an MTL file, added to a scene.
struct MtlMaterial {
  MaterialHandle material;
  std::optional<ColorParam> emission;
};
// Materials by name. `heightUnit`: what a height of 1 in a bump map is in scene units. What cannot
// be read (files, images) is a warning in the scene's findings: an OBJ is complete without.
std::map<std::string, MtlMaterial> readMtl(const std::string& file, float heightUnit, Scene& scene);

}  // namespace lobelia::io
