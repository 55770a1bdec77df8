// Directional albedo of single lobes, from tables and closed forms.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Hemispherical integral over wi of f(wo, wi) |cos(wi)| for a wo of this cosine to the lobe's
// normal (of delta lobes: their factor; for transmission without the 1 / eta^2 of radiance). Zero
// where the lobe does not act. Within 0.5 % of quadrature (of the lobe's maximum) for isotropic
// lobes and Fresnel factors without total reflection; anisotropic ones are taken at the geometric
// mean of their alphas; microfacetTransmission is estimated from the reflection tables.
Rgb lobeAlbedo(const Lobe& lobe, float cosThetaO);

}  // namespace lobelia
