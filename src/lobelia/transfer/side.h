// The side of a surface from which it is seen. A place's, which its geometric normal tells: around
// a silhouette the normals of the vertices next to it look both ways.
#pragma once

#include <cstdint>

namespace lobelia::transfer {

// The front is that of the outside's normal.
enum class Side : uint8_t { front, back };

}  // namespace lobelia::transfer
