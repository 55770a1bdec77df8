// One shadow ray for all points of a strip (cut_kernels.h).
#include "lobelia/base/random.h"
#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/facing_pairs.h"

namespace lobelia::gather {

size_t keepVisibleByOne(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                        uint64_t seed, PairMasks* pairs) {
  keepFacing(tile, block, pairs);
  uint16_t facing[kBlockLights];
  const size_t count = static_cast<size_t>(block.count);
  for (size_t l = 0; l < count; ++l) {
    uint32_t rest = facing[l] = pairs->at(l, 0);
    if (rest == 0) continue;
    const uint64_t random = hashCombine(seed, l) >> 32;
    uint64_t skip = random * static_cast<uint64_t>(__builtin_popcount(rest)) >> 32;
    for (; skip > 0; --skip) rest &= rest - 1;
    pairs->at(l, 0) = static_cast<uint16_t>(rest & (~rest + 1));
  }
  const size_t rays = keepVisible(tile, block, tracer, pairs, false);
  for (size_t l = 0; l < count; ++l)
    if (pairs->at(l, 0) != 0) pairs->at(l, 0) = facing[l];
  return rays;
}

}  // namespace lobelia::gather
