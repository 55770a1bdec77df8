#include "lobelia/gather/light_range.h"

#include <algorithm>

namespace lobelia::gather {

LightRange rangeForDepth(const VirtualLights& lights, LightClass lightClass,
                         const GatherSettings& settings, int receiverDepth) {
  LightRange range;
  range.begin = settings.direct ? 0 : emitterLightCount(lights, lightClass);
  range.end = settings.maxDepth < 0
                  ? lightCount(lights, lightClass)
                  : lightsUpToDepth(lights, lightClass, settings.maxDepth - 1 - receiverDepth);
  range.end = std::max(range.begin, range.end);
  return range;
}

void allowPairs(const Tile& tile, const LightBlock& block, const VirtualLights& lights,
                const GatherSettings& settings, PairMasks* pairs) {
  const size_t count = static_cast<size_t>(block.count);
  pairs->reset(count, tile.strips.size());
  for (size_t s = 0; s < tile.strips.size(); ++s) {
    const PointStrip& strip = tile.strips[s];
    for (size_t l = 0; l < count; ++l) pairs->at(l, s) = static_cast<uint16_t>(strip.active);
    if (settings.maxDepth < 0) continue;
    for (uint32_t lane = 0; lane < kStrip; ++lane) {
      const size_t end = rangeForDepth(lights, block.lightClass, settings, strip.depth[lane]).end;
      for (size_t l = 0; l < count; ++l)
        if (block.index[l] >= end) pairs->at(l, s) &= static_cast<uint16_t>(~(1u << lane));
    }
  }
}

}  // namespace lobelia::gather
