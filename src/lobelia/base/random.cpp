// Owen-scrambled Sobol' points, padded by pairs of dimensions [Burley20].
//
// Deviations: the hash that permutes is the one of N. Vegdahl, "Building a Better LK Hash" (2021),
// whose avalanche is better than that of the paper's; the second Sobol' dimension is multiplied out
// by a butterfly (its matrix is Pascal's triangle modulo 2, a Kronecker power) instead of bit by
// bit.
#include "lobelia/base/random.h"

namespace lobelia {
namespace {

constexpr uint32_t reverseBits(uint32_t v) {
  v = (v << 16) | (v >> 16);
  v = ((v & 0x00ff00ffu) << 8) | ((v & 0xff00ff00u) >> 8);
  v = ((v & 0x0f0f0f0fu) << 4) | ((v & 0xf0f0f0f0u) >> 4);
  v = ((v & 0x33333333u) << 2) | ((v & 0xccccccccu) >> 2);
  return ((v & 0x55555555u) << 1) | ((v & 0xaaaaaaaau) >> 1);
}

// Each bit of the result depends on the seed and on the lower bits of v: an Owen scrambling of the
// bit-reversed number.
constexpr uint32_t permute(uint32_t v, uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

constexpr uint32_t shuffle(uint32_t index, uint32_t seed) {
  return reverseBits(permute(reverseBits(index), seed));
}

// The second Sobol' dimension with its bits reversed: bit j is the parity of the index bits k with
// odd binomial(k, j), that is, of those whose k has every bit of j.
constexpr uint32_t sobolSecondReversed(uint32_t index) {
  index ^= index >> 16;
  index ^= (index & 0xff00ff00u) >> 8;
  index ^= (index & 0xf0f0f0f0u) >> 4;
  index ^= (index & 0xccccccccu) >> 2;
  index ^= (index & 0xaaaaaaaau) >> 1;
  return index;
}

constexpr uint32_t low(uint64_t v) { return static_cast<uint32_t>(v); }
constexpr uint32_t high(uint64_t v) { return static_cast<uint32_t>(v >> 32); }

}  // namespace

float Sampler::next1D() {
  const uint64_t seeds = hashCombine(key_, dimension_++);
  // The first dimension is the bit-reversed index; scrambling reverses, permutes and reverses.
  const uint32_t i = shuffle(index_, low(seeds));
  return toUnitFloat(reverseBits(permute(i, high(seeds))));
}

Vec2f Sampler::next2D() {
  const uint64_t seeds = hashCombine(key_, dimension_);
  const uint64_t more = mixBits(seeds + 0x9e3779b97f4a7c15ull);
  dimension_ += 2;
  const uint32_t i = shuffle(index_, low(seeds));
  const uint32_t x = reverseBits(permute(i, high(seeds)));
  const uint32_t y = reverseBits(permute(sobolSecondReversed(i), low(more)));
  return {toUnitFloat(x), toUnitFloat(y)};
}

}  // namespace lobelia
