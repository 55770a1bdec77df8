// Part of a mesh as a mesh of its own (internal to io).
#pragma once

#include <cstdint>
#include <vector>

#include "lobelia/scene/mesh.h"

namespace lobelia::io {

// The named triangles, in that order, with the vertices that they use in order of first use.
Mesh subset(const Mesh& mesh, const std::vector<uint32_t>& triangles);

}  // namespace lobelia::io
