// The SIMD code of lobe_weights.cpp, compiled for every target and chosen at run time
// (lobe_kernels.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/bsdf/lobe.h"

namespace lobelia::transfer {

// A lobe as seen from wo, at directions x, y, z.
struct LobeLanes {
  const Lobe* lobe;
  const ShadingFrame* frame;
  Vec3f baseNormal;  // before bump and normal maps
  Vec3f wo;          // world
  const float *x, *y, *z;
};

// Where a lobe has anything to speak of: a cone about the mirror direction, above the horizon.
struct LobeCone {
  Vec3f mirror, normal;  // unit, world; the normal on wo's side
  float cosine, sine;    // of the half angle
};

// Cones about chunks of directions.
struct ChunkCones {
  size_t count;
  const float *x, *y, *z, *cosine, *sine;
};

// Luminance of f cos at the directions of the chunks, to out or, unless it is the first lobe,
// added to what is there (lobe_weights.h has the layout).
void addWeights(const LobeLanes& query, std::span<const uint32_t> chunks, bool first, float* out);

// Appends the numbers of the cones that meet one of the lobes'; arrays at whole registers.
void findMeeting(const ChunkCones& cones, std::span<const LobeCone> lobes,
                 std::vector<uint32_t>* chunks);

}  // namespace lobelia::transfer
