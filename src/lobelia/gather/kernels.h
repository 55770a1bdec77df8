// The two stages of a brute-force gather over tile x block of lights, compiled for every SIMD
// target and chosen at run time (kernels.cpp).
#pragma once

#include <vector>

#include "lobelia/gather/aligned_floats.h"
#include "lobelia/gather/light_block.h"
#include "lobelia/gather/tile.h"

namespace lobelia::gather {

// Pairs of a tile and a block: one bit per point, 16 bits per light and strip.
struct PairMasks {
  std::vector<uint16_t> bits;  // [light * strips + strip]
  size_t strips = 0;
  std::vector<uint16_t>* traced = nullptr;  // when set: pairs that keepVisible() traced a ray for
  void reset(size_t lightCount, size_t stripCount) {
    strips = stripCount;
    bits.resize(lightCount * stripCount);
  }
  uint16_t& at(size_t light, size_t strip) { return bits[light * strips + strip]; }
};

// Keeps of the pairs those that face each other (no factor but visibility is zero) and that nothing
// stands between. coherent: a hint to Embree, for speed alone; false where hardly any two rays
// share a light or a receiver. Returns the number of rays traced.
size_t keepVisible(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                   PairMasks* pairs, bool coherent = true);

// Sums over a tile's points, [strip][lane].
struct TileSums {
  struct Strip {
    double x[kStrip] = {}, y[kStrip] = {}, z[kStrip] = {};
    uint32_t nonfinite = 0;  // bit per lane that left out a pair
  };
  std::vector<Strip> strips;
  uint64_t pairs = 0, nonfinite = 0;
};

// Values of pairs of a tile and a block, [light][strip][lane] as PairMasks; 0 where a pair is not
// lit.
struct PairValues {
  AlignedFloats x, y, z;
  uint64_t pairs = 0, nonfinite = 0;
  void reset(size_t lightCount, size_t stripCount) {
    for (AlignedFloats* values : {&x, &y, &z})
      values->assign(lightCount * stripCount * kStrip, 0.f);
  }
};

// Their luminances, at the same places of an array of zeros.
struct PairLuminances {
  float* values = nullptr;
  uint64_t pairs = 0, nonfinite = 0;
};

// Adds the light of the pairs to the sums: in the order of the lights, in float within the block.
// A pair whose value is not finite adds nothing and is counted.
void shade(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
           TileSums* sums);
// The same pairs' values, one by one; values: reset() for the block and tile.
void shadePairs(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
                PairValues* values);

// Of Gaussian lights.
void shadeLuminances(const Tile& tile, const LightBlock& block, float clamp, const PairMasks& pairs,
                     PairLuminances* luminances);

}  // namespace lobelia::gather
