// Light of the samples on surfaces and its sums up the tree [P004 sections 4.1, 4.2].
//
// Deviations: places and normals of nodes are means weighted by the light that samples send, not by
// samples [eq. 5]: lobes are evaluated where the light is. The mean normal is not made unit: its
// cosine is then that of the node's samples, where all of them face the pixel.
#pragma once

#include <span>

#include "lobelia/relight/light_samples.h"
#include "lobelia/relight/light_values.h"

namespace lobelia::relight {

// By heap index (sample_tree.h), 2 << levels entries, the first of no meaning.
struct SurfaceLight {
  LightSums sums;            // radiance times area; x, y, z: mean places, not directions
  AlignedFloats nx, ny, nz;  // mean normals, at most unit
  std::vector<float> size;   // root of the mean squared distance of the light from its place
  float sampleArea = 0;      // that one sample stands for
  Vec3f place(size_t node) const { return sums.direction(node); }
  Vec3f normal(size_t node) const { return {nx[node], ny[node], nz[node]}; }
};

// radiance: of each sample (SampleSurfaces::radiance()). samples: of surfaces.
SurfaceLight surfaceLight(const LightSamples& samples, std::span<const Rgb> radiance);

}  // namespace lobelia::relight
