// Pattern of flowers among leaves, for screens and dishes (internal to this room).
#pragma once

#include "lobelia/base/vec.h"

namespace lobelia::builtin {

enum class FlowerPart : uint8_t { ground, stem, leaf, petal, heart };
// What is at uv (periodic in u and v, one repeat is about 3 x 3 flowers); *tone: 0 to 1 across it.
FlowerPart flowersAt(Vec2f uv, float* tone);

}  // namespace lobelia::builtin
