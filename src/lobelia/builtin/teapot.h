// A teapot (internal to this room).
#pragma once

#include "lobelia/builtin/treasure_items.h"

namespace lobelia::builtin {

// Stands on y = 0, about 2 from spout (+x) to handle, 1 high.
Mesh teapot(const Fineness& fine);

}  // namespace lobelia::builtin
