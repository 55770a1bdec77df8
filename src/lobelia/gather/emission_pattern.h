// Directional pattern of point emitters that became omnidirectional lights.
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::gather {

// Factor to OmniLight::intensity towards `direction` (world space, away from the emitter, any
// length): falloff and picture of a spot; a projector's picture / cos^3; 1 for others.
Rgb emissionPattern(const Scene& scene, uint32_t emitter, Vec3f direction);

}  // namespace lobelia::gather
