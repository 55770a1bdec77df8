// Mixtures of vMF lobes fitted to a lobe's quadrature.
#pragma once

#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::transfer {

struct FitPoint {
  Vec3d w;      // unit
  double mass;  // of the lobe that it stands for; they add up to anything
};
struct FitLobe {
  Vec3d axis{0, 0, 1};  // unit
  double kappa = 1;
  double share = 0;  // of the energy; they sum to 1
};

// Expectation maximisation from the lobes given [Banerjee05], for lobes that are mirror images of
// themselves in the plane y = 0: axes lie in it. Shares add up to one and, unless a kappa was cut
// at kMostKappa (slice_record.h), the mixture's first moment is that of the points. Without points
// the lobes stay as they are.
void fitLobes(std::span<const FitPoint> points, int iterations, std::span<FitLobe> lobes);

}  // namespace lobelia::transfer
