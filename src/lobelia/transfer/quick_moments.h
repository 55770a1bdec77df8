// Moments of a glossy lobe in a few microseconds, for single directions: at hits of textured
// surfaces.
#pragma once

#include "lobelia/transfer/lobe_moments.h"

namespace lobelia::transfer {

// As glossyMoments(): albedo within .5 % (1 % under layers), mean direction within .02 of its
// vector. A tenth of a microsecond for lobes without Fresnel factor, some 5 for others, some 50 for
// anisotropic ones. Threads may call
// this together; the first call for a kind of lobe makes its table (a tenth of a second or so).
LobeMoments quickMoments(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo);

}  // namespace lobelia::transfer
