// A draped figure with a cup and a jug (internal to this room).
#pragma once

#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

// Stands on y = 0 and looks along +z, 1.8 high with the raised cup; `cells` along its height.
Mesh cupbearer(int cells);

}  // namespace lobelia::builtin
