// The inner loops of a pixel, compiled for every SIMD target and chosen at run time
// (pixel_kernels.cpp). Registers run over nodes of the light, the pixel's material is the same in
// all lanes: no lane waits for another, and small triangles cost no more than large ones.
#pragma once

#include <algorithm>

#include "lobelia/bsdf/lobe.h"
#include "lobelia/relight/fine_light.h"
#include "lobelia/relight/vertex_light.h"

namespace lobelia::relight {

// Light that arrives at a pixel from the directions of nodes, chunk by chunk.
struct DirectedLight {
  AlignedFloats x, y, z;        // unit directions
  AlignedFloats r, g, b;        // visible radiance times solid angle; 0 behind the surface
  std::vector<uint32_t> chunk;  // whose light it is: chunk[i] of the light cut
  std::vector<uint16_t> lit;    // bit per lane: is there light?
  size_t chunkCount = 0;

  void reserve(size_t chunks);  // room for so many
};

// The bits of a chunk's nodes that lie in [begin, end).
inline uint16_t chunkMask(uint32_t chunk, uint32_t begin, uint32_t end) {
  const uint32_t first = chunk * static_cast<uint32_t>(kChunk);
  const uint32_t from = begin > first ? begin - first : 0;
  const uint32_t to = std::min<uint32_t>(end - first, kChunk);
  return static_cast<uint16_t>((1u << to) - (1u << from));
}

// For every chunk, a bit for each node that has light.
void findLit(const LightRows& rows, size_t chunkCount, uint16_t* lit);

// Nodes with their directions, and the light that the pixel's three vertices see of them.
struct VertexLights {
  const float* direction[3];  // x, y, z of the first node, at whole chunks
  ConstLightRows rows[3];     // by vertex
  float weight[3];
  const uint16_t* lit[3];  // by vertex, of findLit(); null: may be anything
};

// Appends the chunks of [0, chunkCount) that have light in front of the surface; there has to be
// room. normal: geometric, on the side of the eye.
void appendLight(const VertexLights& lights, size_t chunkCount, Vec3f normal, DirectedLight* out);

// A lobe as seen from wo.
struct LobeQuery {
  const Lobe* lobe;
  const ShadingFrame* frame;
  Vec3f baseNormal;  // before bump and normal maps
  Vec3f wo;          // world
  // Registers are left out whose directions are all farther than this from the mirror direction.
  Vec3f mirror{};
  float leastCosine = -2;  // -2: none is
};
// Sum of f cos times light over the lanes of the masks ([chunkCount]), in the order of nodes lane
// by lane. Reflecting lobes that are no delta lobes. *evaluations grows by the lanes evaluated.
Rgb sumLobe(const LobeQuery& query, const DirectedLight& light, const uint16_t* masks,
            uint64_t* evaluations);

// Appends the units that a cone of half angle `radius` about `axis` may meet, in their order.
void findUnits(const FineUnits& units, Vec3f axis, float radius, std::vector<uint32_t>* found);

}  // namespace lobelia::relight
