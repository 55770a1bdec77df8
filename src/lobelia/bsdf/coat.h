// What a dielectric coat does to the diffuse base below it: smooth and rough plastic as Mitsuba 3
// has them.
#pragma once

#include "lobelia/bsdf/layers.h"

namespace lobelia {

// Reflectance of a smooth dielectric interface for diffuse light, eta = n(other side) / n(side of
// the light): the fits of Egan and Hilgeman 1973 (eta < 1) and d'Eon and Irving 2011.
float fresnelDiffuseReflectance(float eta);

struct RoughCoat {
  TransmittanceTable transmittance;
  float internalReflectance = 0;  // for diffuse light from inside
};

// The coat of a rough interface (isotropic), integrated on first use and kept for the process.
// Threads may call this together; the reference stays valid. Alphas that vary over a surface should
// be rounded first (each value costs some 20 ms).
const RoughCoat& roughCoat(Distribution distribution, float alpha, float eta);

}  // namespace lobelia
