// A generated environment: a warm hall with tall windows and lamps (internal to this room).
#pragma once

#include "lobelia/scene/texture.h"

namespace lobelia::builtin {

// Equirectangular, y up, `height` rows and twice as many columns.
Image hallLight(int height);

}  // namespace lobelia::builtin
