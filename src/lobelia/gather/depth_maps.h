// Shadow maps of virtual spherical Gaussian lights, by ray casting: from the places
// where a light's shadow rays end, the distance to the nearest surface in the directions of an
// octahedral map. One look in place of a ray: shadows are as sharp as a texel (depth_lookup-inl.h
// says what counts as lit). Most looks are into the first place's map, the finest.
//
// Deviation from [P001 supplement, section 3.2], which renders maps of half spaces: octahedral maps
// have all directions, for clusters whose normals spread widely.
#pragma once

#include <vector>

#include "lobelia/gather/aligned_floats.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::gather {

class DepthMaps {
 public:
  // Of all Gaussian lights; texels: on a side of the first place's map, at least 2, of the others'
  // half of it. The same for any number of threads. Counts "shadow_rays" and books seconds to
  // "visibility". Throws RuntimeError where the machine has not so much memory. When cancelled,
  // maps may be missing.
  DepthMaps(const Tracer& tracer, const VirtualLights& lights, int texels, Context& context);
  // Of one light.
  static size_t bytes(int texels);

  int texels(int place) const { return place == 0 ? texels_ : texels_ / 2; }
  // [row][column], infinite where there is nothing, 0 where the light sends nothing.
  const float* of(size_t light, int place) const { return &depths_[first(light, place)]; }

 private:
  size_t first(size_t light, int place) const {
    const size_t whole = static_cast<size_t>(texels_) * static_cast<size_t>(texels_);
    const size_t half = static_cast<size_t>(texels_ / 2) * static_cast<size_t>(texels_ / 2);
    const size_t own = place == 0 ? 0 : whole + static_cast<size_t>(place - 1) * half;
    return light * (bytes(texels_) / sizeof(float)) + own;
  }

  const int texels_;
  AlignedFloats depths_;
};

// Direction of the place (u, v) in [-1,1]² of an octahedral map [Cigolle14], not of unit length.
Vec3f octahedralDirection(float u, float v);

}  // namespace lobelia::gather
