// Sampling of micro-normals and its density. All directions in the lobe's frame, w.z > 0.
//
// GGX: visible normals by spherical caps (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
// with Spherical Caps"). Beckmann: visible normals by numerical inversion (Jakob 2014, "An Improved
// Visible Normal Sampling Routine for the Beckmann Distribution", here with a bracketed Newton
// iteration). Phong (Ashikhmin and Shirley 2000) and GTR1 (Burley 2012): the whole distribution,
// D cos; spherical Gaussians: D itself, a von Mises-Fisher distribution.
#pragma once

#include "lobelia/base/vec.h"
#include "lobelia/bsdf/lobe.h"

namespace lobelia {

Vec3f sampleMicroNormal(Distribution distribution, float alphaX, float alphaY, Vec3f w, Vec2f u);
// Density of sampleMicroNormal() per solid angle of m. Exact also for Beckmann, whose evaluation
// uses a rational fit of the masking term: the weights then carry that fit's ratio.
float microNormalPdf(Distribution distribution, float alphaX, float alphaY, Vec3f w, Vec3f m);

// Inverse of the error function; finite also for |x| = 1.
float inverseErf(float x);

}  // namespace lobelia
