// Which points of a tile face which lights of a block, in registers.
#pragma once

#include "lobelia/gather/kernels.h"

namespace lobelia::gather {

// Keeps of the pairs those that face each other: no factor but visibility is zero.
void keepFacing(const Tile& tile, const LightBlock& block, PairMasks* pairs);
// The same of one pair, bit for bit.
bool faces(const Tile& tile, size_t strip, size_t lane, const LightBlock& block, size_t light);

}  // namespace lobelia::gather
