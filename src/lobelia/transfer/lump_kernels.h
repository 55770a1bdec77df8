// Sums of lumps' lobes at directions, compiled for every SIMD target and chosen at run time.
#pragma once

#include <cstddef>

#include "lobelia/transfer/light_lumps.h"

namespace lobelia::transfer {

inline constexpr size_t kBlockTexels = 16;

struct TexelBlock {
  alignas(64) float x[kBlockTexels], y[kBlockTexels], z[kBlockTexels];  // unit directions
  alignas(64) float r[kBlockTexels], g[kBlockTexels], b[kBlockTexels];  // sums
};

// Adds the lumps [begin, end), one after the other.
void addLumps(const LumpLobes& lobes, size_t begin, size_t end, TexelBlock* block);

}  // namespace lobelia::transfer
