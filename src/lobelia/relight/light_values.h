// Light at the samples and its sums up the tree [P004 section 4.2].
//
// Every directed power goes to the nearest sample: the whole of an environment's light arrives,
// whatever its map (a sun of one texel, which looking up a coarser mip level would miss or double).
// Deviation: a node's direction is the mean of its light's directions, not of its samples'
// [eq. 5], so that a lobe is evaluated where the light is.
#pragma once

#include <tbb/cache_aligned_allocator.h>

#include <vector>

#include "lobelia/relight/direction_lookup.h"
#include "lobelia/relight/distant_light.h"
#include "lobelia/relight/sample_tree.h"

namespace lobelia::relight {

using AlignedFloats = std::vector<float, tbb::cache_aligned_allocator<float>>;

// By heap index (sample_tree.h), 2 << levels entries, the first of no meaning.
struct LightSums {
  int levels = 0;
  // Radiance times solid angle, summed over the leaves below: a node's three numbers in one line of
  // the cache, since merges look nodes up one by one.
  struct alignas(16) Power {
    Rgb rgb{};
  };
  std::vector<Power> powers;
  AlignedFloats rows;     // the same, red after red, then green and blue, for registers of nodes
  AlignedFloats x, y, z;  // unit direction: of the light, or of the samples where there is none
  Rgb power(size_t node) const { return powers[node].rgb; }
  void setPower(size_t node, Rgb power) {
    powers[node].rgb = power;
    for (size_t c = 0; c < 3; ++c) rows[powers.size() * c + node] = power[static_cast<int>(c)];
  }
  void resize(int newLevels);  // all zero
  Vec3f direction(size_t node) const { return {x[node], y[node], z[node]}; }
};

// light: of directions as the scene has them; turned: takes directions of the light to the world,
// a rotation. lookup: of samples.p. samples: of an environment.
LightSums lightSums(const DistantLight& light, const Mat4& turned, const LightSamples& samples,
                    const DirectionLookup& lookup);

}  // namespace lobelia::relight
