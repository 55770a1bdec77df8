// The inner loop of a pixel lit from surfaces, compiled for every SIMD target and chosen at run
// time. What it makes are directions with light, which the lobes of pixel_kernels.h take.
#pragma once

#include <span>

#include "lobelia/relight/pixel_kernels.h"

namespace lobelia::relight {

// Light that arrives at a pixel from nodes of some extent.
struct NearLight : DirectedLight {
  AlignedFloats widening;  // of squared roughness, by node (sumWidenedLobe())
  // One more chunk: registers are stored whole.
  void reserve(size_t most) {
    const size_t chunks = most + 1;
    DirectedLight::reserve(chunks);
    if (widening.size() < chunks * kChunk) widening.resize(chunks * kChunk, 0.f);
  }
};

// Nodes with their places and normals, and the light that the pixel's three vertices see of them.
// All arrays are of whole chunks.
struct NearLights {
  const float* place[3];   // x, y, z
  const float* normal[3];  // means, at most unit
  // The mean of max(0, n.w) over a node's normals, of which c = n.w of the mean normal is known, is
  // taken as (c + sqrt(c^2 + v)) / 2 with v = (1 - |n|^2) / 4: exact for one normal and for a ball,
  // and never nothing where some of a node faces the pixel.
  const float* variance;
  const float* extent2;  // mean squared distance of the light from the place
  LightRows rows[3];     // by vertex: radiance times area, visible
  float weight[3];
  // A sample's disc of area A at distance d sends 1 / (d^2 + A / pi) along its axis where a point
  // sends 1 / d^2: A / pi. A pixel nearer to the disc's plane than half the disc's radius is taken
  // to be so far above it: else it would lie between samples, and corners would be dark.
  float softening = 0;
};

// Fills *out, which has to have room, with those nodes of the chunks, packed, that have light for a
// place p: radiance times solid angle from each node in front of the surface that faces p. normal:
// geometric, on the side of the eye.
void gatherNearLight(const NearLights& lights, std::span<const uint32_t> chunks, Vec3f p,
                     Vec3f normal, NearLight* out);

// Like sumLobe(), with lobes as much broader as nodes are wide: a lobe narrower than a node would
// see all of its light or none. Half vectors of deviation alpha / sqrt(2) along an axis reflect
// into directions of deviation sqrt(2) alpha; light from a disc at distance d with the mean square
// e2 of distances from its middle has sqrt(e2 / 2) / d; both add up squared: alpha^2 grows by e2 /
// (4 d^2). reach: chord about query.mirror beyond which nodes are left out; 2: none is.
Rgb sumWidenedLobe(const LobeQuery& query, const NearLight& light, float reach,
                   uint64_t* evaluations);

}  // namespace lobelia::relight
