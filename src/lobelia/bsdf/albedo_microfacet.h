// Directional albedo of microfacet reflection with any Fresnel factor.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// cosine > 0: of wo on the side it is on; behind: an interface seen from inside. With complement,
// the integral of one minus the Fresnel factor. Without Lobe::weight.
Rgb microfacetAlbedo(const Lobe& lobe, float cosine, bool behind, bool complement);

}  // namespace lobelia
