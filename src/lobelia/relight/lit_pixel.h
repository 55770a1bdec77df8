// A pixel's surface in a frame under local lights, with what is random at it.
#pragma once

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/scene/shading.h"

namespace lobelia::relight {

struct LitPixel {
  SurfacePoint at;
  Bsdf bsdf;  // its lobes are sharp where they are followed by a ray (local_mirror.h)
  Vec3f wo;
  Vec3f normal;        // geometric, on the side of wo
  Vec2f places{};      // of area emitters
  float lobe = 0;      // which of the sharp lobes the ray takes,
  Vec2f mirrored{};    // and where
  uint32_t pixel = 0;  // of the tile's
  Rgb sum{};
};

}  // namespace lobelia::relight
