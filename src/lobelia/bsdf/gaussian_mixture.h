// Mixtures of spherical Gaussians fitted to a lobe, and tables of such fits.
#pragma once

#include <span>

#include "lobelia/bsdf/gaussian_shape.h"

namespace lobelia {

// A direction above the horizon (z > 0) drawn from a lobe.
struct LobeSample {
  Vec3f w;
  float weight;      // value over density, up to a common factor
  float solidAngle;  // 1 / (number drawn * density)
};

// Fits vMF lobes of which only the part above the horizon is seen, by expectation maximisation
// from the parts given. In: shares of the whole lobes. Out: shares of the energy above the horizon.
// cutOff: allow for what is below the horizon. Throws std::invalid_argument for samples that are
// not finite: one of them would leave a lobe without any energy.
void fitMixture(std::span<const LobeSample> samples, int iterations, bool cutOff,
                std::span<ShapePart> parts);
// Estimate of the relative L1 distance between the lobe and parts with shares above the horizon.
// Throws as fitMixture().
float mixtureError(std::span<const LobeSample> samples, std::span<const ShapePart> parts);

// Isotropic reflection (microfacets but for gtr1, and Ward) from tables that are fitted on first
// use; wo in front. Needs parts.size() >= kTableParts; writes twice as many where there is room,
// which interpolates between angles. 0: no table for this lobe.
inline constexpr int kTableParts = 6;
int tabulatedShape(const Lobe& lobe, Vec3f wo, std::span<ShapePart> parts);

}  // namespace lobelia
