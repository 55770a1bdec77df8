// Captured reflectance (bsdf/captured.h) fitted to a table of measurements.
#pragma once

#include <vector>

#include "lobelia/bsdf/tabulated_brdf.h"

namespace lobelia {

struct FittedLobe {
  Rgb amplitude{};
  float sharpness = 1;
};
struct CapturedFit {
  Rgb diffuse{};
  float ior = 1;                  // 1: no Fresnel term
  std::vector<FittedLobe> lobes;  // sharpest first
  // Of the cube roots of f sqrt(cos cos): root mean square difference over the root mean square.
  double error = 0;
  // Largest relative difference of a channel's total energy over all pairs of directions.
  double energyError = 0;
  size_t samples = 0;  // table entries that were compared
};

inline constexpr int kMaxFittedLobes = 7;

// Diffuse reflectance and up to lobeCount (1 to kMaxFittedLobes) Gaussians. The table must hold a
// measured value. Same table, same bits.
CapturedFit fitCaptured(const TabulatedBrdf& table, int lobeCount);

}  // namespace lobelia
