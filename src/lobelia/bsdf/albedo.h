// Directional albedo of single lobes, from tables and closed forms.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Where the tables of sheen begin. Below, it reflects more than it gets at grazing angles.
inline constexpr float kMinSheenAlpha = 0.07f;

// Hemispherical integral over wi of f(wo, wi) |cos(wi)| for a wo of this cosine to the lobe's
// normal (of delta lobes: their factor; for transmission without the 1 / eta^2 of radiance). Zero
// where the lobe does not act. Within 0.5 % of quadrature for isotropic lobes and Fresnel factors
// without total reflection; an estimate (some percent) for anisotropic lobes,
// microfacetTransmission, interfaces seen from inside and lobes under other layers.
Rgb lobeAlbedo(const Lobe& lobe, float cosThetaO);

}  // namespace lobelia
