// Arrays of floats that SIMD registers load whole.
#pragma once

#include <tbb/cache_aligned_allocator.h>

#include <vector>

namespace lobelia::gather {

using AlignedFloats = std::vector<float, tbb::cache_aligned_allocator<float>>;

}  // namespace lobelia::gather
