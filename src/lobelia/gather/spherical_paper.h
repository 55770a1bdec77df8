// Spherical lights as the paper has them, in scalar code: the integral of equation 5 by cone and
// BSDF sampling, and the photon light that it stands for.
#pragma once

#include <span>

#include "lobelia/base/random.h"
#include "lobelia/gather/light_block.h"
#include "lobelia/gather/tile.h"

namespace lobelia::gather {

// One pair: a receiver and a light.
struct SpherePair {
  const ReceiverPoint& point;
  Bsdf bsdf;  // of the receiver, rough lobes
  const PreparedLight& light;
  const PreparedSphere& sphere;
  SphereShading::Indicator indicator;
};

// Integral of equation 5 without visibility and without power over area, by `counts[i]` directions
// of the strategies cone, receiver's BSDF and light's BSDF, combined by the balance heuristic
// [Veach95]; the cone's density must not be left out where the others do not cover all. A mean over
// `random` is the integral for any counts whose strategies cover the integrand.
Rgb integrateBySampling(const SpherePair& pair, const std::array<int, 3>& counts, Rng* random);
// As section 3.3 counts them: in proportion to the cone's solid angle, at most 100 for a
// hemisphere, a third for each strategy; where there is one, it is drawn among the three.
Rgb integrateAsPrinted(const SpherePair& pair, Rng* random);
// As many directions, all of the cone.
Rgb integrateByCone(const SpherePair& pair, Rng* random);

// integrateAsPrinted() or integrateByCone(), as the block's shading says, for a lane of a tile,
// with random numbers of the pair's own.
Rgb evaluateAsPrinted(const Tile& tile, size_t stripIndex, size_t lane, const LightBlock& block,
                      size_t light);

// The photon light [Hasan09 eq. 2-4]: radiance that the receiver sends to wo of what the light
// splats on all surface within its radius, by `samples` rays into its cone. With power and area,
// that is all that the VSL approximates, visibility included.
Rgb photonLight(const Tracer& tracer, const SpherePair& pair, const SphericalLight& light,
                float specularLimit, int samples, Rng* random);

}  // namespace lobelia::gather
