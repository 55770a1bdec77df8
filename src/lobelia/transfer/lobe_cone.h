// How far from the mirror direction a lobe has anything to speak of.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia::transfer {

// Angle in radians about the mirror direction of wo (in the lobe's frame, active), outside of which
// f cos is less than `share` times its value there. kPi for lobes that reflect about evenly. Of
// reflecting lobes that are no delta lobes.
float coneAngle(const Lobe& lobe, Vec3f wo, float share);

}  // namespace lobelia::transfer
