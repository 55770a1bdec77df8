// The inner loops of matrix row-column sampling for every SIMD target.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lobelia/gather/aligned_floats.h"

namespace lobelia::gather {

// Lengths of vectors are multiples of it; their memory is aligned to 64 bytes.
inline constexpr size_t kMrcsLanes = 16;

// sketch[d] = sum over r of row[r] * signs[r * dims + d].
void sketchRow(const float* row, size_t length, const float* signs, size_t dims, float* sketch);

// Half floats and back; unpacked values are multiplied by scale.
void packHalves(const float* values, size_t count, uint16_t* halves);
void unpackHalves(const uint16_t* halves, size_t count, float scale, float* values);

float dotProduct(const float* a, const float* b, size_t count);
void addScaled(float factor, const float* values, size_t count, float* sum);

// Centres c_k with gains g_k and squared lengths q_k, laid out for scoring 16 at once.
struct CentreTable {
  size_t count = 0, groups = 0, dims = 0;
  AlignedFloats vectors;       // [group][dim][16]: 2 g c
  AlignedFloats gain, offset;  // [group][16]: g; g q
  CentreTable(size_t centreCount, size_t dimensions);
  void set(size_t k, const float* centre, float squaredLength, float gainOfCentre);
};
// best[i] = the k of least g_k (q_i + q_k - 2 a_i.c_k), the first of equals. vectors: count x dims.
void nearestCentres(const float* vectors, const float* squaredLengths, size_t count,
                    const CentreTable& centres, uint32_t* best);

}  // namespace lobelia::gather
