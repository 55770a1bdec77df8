// Randomness as a pure function of (seed, stream, index, dimension).
#pragma once

#include <cstdint>

#include "lobelia/base/vec.h"

namespace lobelia {

// A good 64-bit mixer (the finaliser of SplitMix64, Steele et al. 2014).
constexpr uint64_t mixBits(uint64_t v) {
  v ^= v >> 30, v *= 0xbf58476d1ce4e5b9ull;
  v ^= v >> 27, v *= 0x94d049bb133111ebull;
  return v ^ (v >> 31);
}
constexpr uint64_t hashCombine(uint64_t a, uint64_t b) {
  return mixBits(a + 0x9e3779b97f4a7c15ull * (b + 1));
}
// [0,1), 24 bits.
constexpr float toUnitFloat(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

// PCG32 (O'Neill 2014): small sequential generator for tests and for streams without a natural
// dimension count.
class Rng {
 public:
  explicit Rng(uint64_t seed, uint64_t stream = 0)
      : state_(mixBits(seed ^ mixBits(stream))), inc_((mixBits(stream + 0x632be59bd9b4e019ull) << 1) | 1) {
    nextUint();
  }
  uint32_t nextUint() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + inc_;
    const uint32_t xorshifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const uint32_t rot = static_cast<uint32_t>(old >> 59);
    return (xorshifted >> rot) | (xorshifted << ((32 - rot) & 31));
  }
  float next1D() { return toUnitFloat(nextUint()); }
  Vec2f next2D() {
    const float x = next1D();
    return {x, next1D()};
  }

 private:
  uint64_t state_, inc_;
};

// Owen-scrambled Sobol' points (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)),
// padded: every next1D()/next2D() call takes the next dimension (pair) with its own shuffling and
// scrambling seed. Sample `index` of stream `stream` (a pixel, say) is always the same.
class Sampler {
 public:
  Sampler(uint64_t seed, uint64_t stream, uint32_t index)
      : key_(hashCombine(seed, stream)), index_(index) {}
  float next1D();
  Vec2f next2D();
  uint32_t dimension() const { return dimension_; }
  void setDimension(uint32_t dimension) { dimension_ = dimension; }

 private:
  uint64_t key_;
  uint32_t index_;
  uint32_t dimension_ = 0;
};

}  // namespace lobelia
