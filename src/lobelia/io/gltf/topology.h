// Triangles of a primitive from its mode and indices.
#pragma once

#include "lobelia/base/vec.h"
#include "lobelia/io/gltf/import.h"

namespace lobelia::io::gltf {

// `indices` as stored, all below the number of vertices. Points and lines give none, with a
// finding. Triangles of strips and fans that name a vertex twice are stitches and left out.
// `areFaces`: three indices make a triangle whatever the mode, as in compressed data.
std::vector<Vec3u> trianglesOf(const Import& import, const Json& primitive,
                               const std::vector<uint32_t>& indices, bool areFaces);

}  // namespace lobelia::io::gltf
