// The inner loop of precomputation: a surface's lobes at many fixed directions, in SIMD registers
// of directions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/bsdf/lobe.h"
#include "lobelia/relight/light_cut.h"

namespace lobelia::transfer {

// Directions in chunks of relight::kChunk in a row, each chunk with a cone about it: those of a
// GeodesicGrid, which are close in a row.
struct DirectionChunks {
  // directions: unit.
  explicit DirectionChunks(std::span<const Vec3f> directions);
  size_t chunkCount() const { return x.size() / relight::kChunk; }

  size_t count = 0;                // of directions; lanes after it hold the last one
  relight::AlignedFloats x, y, z;  // by direction
  // By chunk, filled up to whole registers: unit axis, cosine and sine of the half angle.
  relight::AlignedFloats axisX, axisY, axisZ, cosine, sine;
};

// The chunks, ascending, that may hold directions in which a lobe of `part` has more than 1e-3 of
// its value in the mirror direction, and are not all below its horizon. part: diffusePart() or
// glossyPart(). What was in `chunks` is replaced.
void findChunks(const DirectionChunks& directions, const Bsdf& part, Vec3f wo,
                std::vector<uint32_t>* chunks);

// Luminance of evaluate(part, wo, w) for the directions w of the chunks: out[i * kChunk + lane] is
// that of lane `lane` of chunk chunks[i], 0 after the last direction. out: aligned as AlignedFloats
// are, room for chunks.size() * kChunk. Differs from evaluate() by rounding.
void lobeWeights(const DirectionChunks& directions, const Bsdf& part, Vec3f wo,
                 std::span<const uint32_t> chunks, float* out);

}  // namespace lobelia::transfer
