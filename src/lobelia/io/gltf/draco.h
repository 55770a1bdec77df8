// KHR_draco_mesh_compression: a primitive's triangles and attributes from one compressed block.
#pragma once

#include <map>
#include <optional>

#include "lobelia/io/gltf/accessors.h"

namespace lobelia::io::gltf {

struct DracoPrimitive {
  std::vector<uint32_t> indices;                 // triangles
  std::map<std::string, FloatArray> attributes;  // by glTF's names
};

// Empty when the primitive is not compressed.
std::optional<DracoPrimitive> decodeDraco(Document& document, const Json& primitive);

}  // namespace lobelia::io::gltf
