// Statues of animals that stand in for the scanned models of the papers (internal to this room).
// `cells` along their longest side; triangles grow as its square. y is up, they stand on y = 0.
#pragma once

#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

Mesh dragonStatue(int cells);  // looks along -x, about 2 long and 1.6 high
Mesh monkeyHead(int cells);    // looks along +z, about 2 wide and 1.7 high
Mesh hareStatue(int cells);    // looks along +z, about 1.6 high

}  // namespace lobelia::builtin
