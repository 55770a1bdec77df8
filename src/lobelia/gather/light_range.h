// Which lights a receiver gathers: emitters or not, and as deep as --max-depth lets it.
#pragma once

#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"

namespace lobelia::gather {

// Half-open range of lights of a class.
struct LightRange {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
};

// The lights of a class that a receiver of this depth gathers from.
LightRange rangeForDepth(const VirtualLights& lights, LightClass lightClass,
                         const GatherSettings& settings, int receiverDepth);

// Sets `pairs` to all pairs of points and lights that depth allows.
void allowPairs(const Tile& tile, const LightBlock& block, const VirtualLights& lights,
                const GatherSettings& settings, PairMasks* pairs);

}  // namespace lobelia::gather
