// Directional albedo of microfacet lobes.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// cosine > 0: of wo on the side it is on; behind: an interface seen from inside. Without
// Lobe::weight.
Rgb microfacetReflectance(const Lobe& lobe, float cosine, bool behind);
// Of an interface, without the 1 / eta^2 of radiance: an estimate (see the head of the .cpp).
float microfacetTransmittance(const Lobe& lobe, float cosine, bool behind);

}  // namespace lobelia
