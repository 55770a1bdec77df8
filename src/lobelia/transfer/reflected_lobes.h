// A glossy lobe as a few vMF lobes, for looking up light from infinity.
#pragma once

#include <span>

#include "lobelia/transfer/lobe_moments.h"
#include "lobelia/transfer/reflection.h"

namespace lobelia::transfer {

// The one lobe of these moments, which reflect something.
ReflectedLobe reflectedLobe(const LobeMoments& moments);

// Writes at most lobes.size() (1 to Reflection::kMostLobes) lobes whose alphas add up to the
// moments' albedo, and returns their number; 0: nothing is reflected. moments: glossyMoments() of
// the lobe for this wo. points: of the quadrature of anisotropic lobes, a power of two.
inline constexpr uint32_t kRowPoints = 512;
int reflectedLobes(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, const LobeMoments& moments,
                   std::span<ReflectedLobe> lobes, uint32_t points = kRowPoints);

}  // namespace lobelia::transfer
