// The inner loop of a pixel lit from surfaces, compiled for every SIMD target and chosen at run
// time. What it makes are directions with light, which the lobes of pixel_kernels.h take.
#pragma once

#include "lobelia/relight/pixel_kernels.h"

namespace lobelia::relight {

// Nodes with their places and normals, and the light that the pixel's three vertices see of them.
struct NearLights {
  const float* place[3];   // x, y, z of the nodes, at whole chunks
  const float* normal[3];  // at most unit
  LightRows rows[3];       // by vertex: radiance times area, visible
  float weight[3];
  // A sample's disc of area A at distance d sends 1 / (d^2 + A / pi) along its axis where a point
  // sends 1 / d^2: A / pi.
  float softening = 0;
};

// Fills *out, which has to have room, with the chunks of [0, chunkCount) that have light for a
// place p: radiance times solid angle from each node in front of the surface that faces p. normal:
// geometric, on the side of the eye.
void gatherNearLight(const NearLights& lights, size_t chunkCount, Vec3f p, Vec3f normal,
                     DirectedLight* out);

}  // namespace lobelia::relight
