// Statues of animals that stand in for the scanned models of the papers (internal to this room).
// `cells` along their longest side; triangles grow as its square. y is up, they stand on y = 0.
#pragma once

#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

// Looks along -x, about 2 long and 1.6 high. skin: thickness of the wings, which have holes where
// it is less than two cells.
Mesh dragonStatue(int cells, float skin = 0.022f);
Mesh monkeyHead(int cells);  // looks along +z, about 2 wide and 1.7 high
Mesh hareStatue(int cells);  // looks along +z, about 1.6 high

}  // namespace lobelia::builtin
