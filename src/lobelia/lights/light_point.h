// Point lights with both parts of their intensity: what a texel of a reflective shadow map holds
// [P001 supplement, section 3.3], and what clusters are made of.
#pragma once

#include <span>

#include "lobelia/lights/virtual_lights.h"

namespace lobelia {

struct LightPoint {
  Vec3f p;
  Vec3f n{0, 0, 1};     // geometric normal of the side that the light leaves
  Rgb diffuse{};        // W, what leaves by a cosine lobe around n
  Rgb glossy{};         // W, what leaves by the Gaussian, above the surface
  Vec3f axis{0, 0, 1};  // of the Gaussian
  float sharpness = 0;
  uint16_t group = 0;
  uint16_t depth = 0;
  float power() const { return luminance(diffuse) + luminance(glossy); }
};

// The same light as diffuse and glossy lights, for `lights` that have none.
void addPointLights(std::span<const LightPoint> points, VirtualLights* lights);

}  // namespace lobelia
