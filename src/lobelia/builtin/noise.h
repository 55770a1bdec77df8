// Periodic noise for generated textures and shapes (internal to this room): gradient noise and its
// sums over octaves [K. Perlin, "Improving Noise", SIGGRAPH 2002, with hashed gradients].
#pragma once

#include "lobelia/base/vec.h"

namespace lobelia::builtin {

// About -1 to 1, mean 0; repeats exactly after `period` lattice cells along each axis.
float noise(Vec2f at, Vec2i period, uint64_t seed);
// Sum of octaves, each twice as fine and `gain` times as high as the one before; about -1 to 1.
float fbm(Vec2f at, Vec2i period, int octaves, uint64_t seed, float gain = 0.5f);
// In space, not periodic.
float noise(Vec3f at, uint64_t seed);
float fbm(Vec3f at, int octaves, uint64_t seed, float gain = 0.5f);
// Uniform in [0,1), a function of a lattice point.
float cellRandom(int x, int y, uint64_t seed);

}  // namespace lobelia::builtin
