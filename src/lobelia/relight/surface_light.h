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

// Covariance of places, symmetric.
struct Spread {
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  float trace() const { return xx + yy + zz; }
  // Mean squared distance along a unit direction.
  float along(Vec3f d) const {
    return xx * d.x * d.x + yy * d.y * d.y + zz * d.z * d.z +
           2 * (xy * d.x * d.y + xz * d.x * d.z + yz * d.y * d.z);
  }
};

// By heap index (sample_tree.h), 2 << levels entries, the first of no meaning.
struct SurfaceLight {
  LightSums sums;              // radiance times area; x, y, z: mean places, not directions
  AlignedFloats nx, ny, nz;    // mean normals, at most unit
  std::vector<Spread> spread;  // of the light about the mean place
  float sampleArea = 0;        // that one sample stands for
  Vec3f place(size_t node) const { return sums.direction(node); }
  Vec3f normal(size_t node) const { return {nx[node], ny[node], nz[node]}; }
};

// radiance: of each sample (SampleSurfaces::radiance()). samples: of surfaces.
SurfaceLight surfaceLight(const LightSamples& samples, std::span<const Rgb> radiance);

}  // namespace lobelia::relight
