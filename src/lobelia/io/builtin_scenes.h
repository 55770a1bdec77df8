// The makers of the built-in scenes (internal to io).
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::io {

Scene makeCornell(float detail);

}  // namespace lobelia::io
