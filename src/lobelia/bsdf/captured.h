// Captured reflectance as a sum of spherical Gaussians of the half vector [P000 eq. 5, Wang09]:
//   rho(o, i) = kd T(o) T(i) / pi + sum_k D_k(h) F(o.h) G(o) G(i) / (4 (n.o) (n.i)),
//   D_k(h) = amplitude_k exp(sharpness_k (h.n - 1)).
// F is the Fresnel reflectance of a dielectric of index `ior`, or 1 where ior is 1 (metals, cloth);
// G is Smith's masking of D_k (bsdf/kernels-inl.h). T, 1 at normal incidence, is what F leaves of
// the diffuse light at grazing angles.
// Deviation: Wang09 has T = 1, which creates energy at grazing angles where F is not 1.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Lobes wider than this are taken as this wide (it is nearly diffuse).
inline constexpr float kMinCapturedSharpness = 0.5f;

// Integral of exp(sharpness (h.n - 1)) (h.n) over the hemisphere of h. A lobe of amplitude 1 / this
// has the micro-normals of a whole surface: it reflects at most 1.
float projectedIntegral(float sharpness);

// Without sides and sampling shares. The lobe's weight is amplitude * projectedIntegral.
Lobe capturedLobe(Rgb amplitude, float sharpness, float ior);
Lobe capturedDiffuse(Rgb diffuse, float ior);

// Largest factor, at most 1, that makes a diffuse part and lobes of this total weight reflect no
// more than they receive.
float capturedScale(Rgb diffuse, Rgb weights, float ior);

}  // namespace lobelia
