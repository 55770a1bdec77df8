// A BSDF's rough lobes as spherical Gaussians of the outgoing direction (methods.md 0.5).
#pragma once

#include <array>

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Radiant intensity per unit incident power: amplitude * exp(sharpness (axis.w - 1)), cosine
// included, clipped at the horizon of `normal`.
struct GaussianLobe {
  Vec3f axis{0, 0, 1};
  float sharpness = 1;
  Rgb amplitude{};
  Vec3f normal{0, 0, 1};  // side of the surface that it leaves
};

struct LobeExpansion {
  // Diffuse (cosine) part: intensity is diffuse/pi * max(0, n.w), n towards the incident side;
  // transmitted: the same on the other side.
  Rgb diffuse{}, diffuseTransmitted{};
  static constexpr int kMaxGaussians = 32;
  int count = 0;
  std::array<GaussianLobe, kMaxGaussians> gaussians;
};

// The rough lobes of the BSDF for light that arrives from direction wi (leaving the surface), as a
// function of the outgoing direction. The energy of every Gaussian above the horizon is scaled to
// the lobe's directional albedo times arrivingShare() (bsdf/bsdf.h) of its frame.
// `gaussiansPerLobe`: upper limit per lobe, 1 for the paper's form.
LobeExpansion expand(const Bsdf& bsdf, Vec3f wi, int gaussiansPerLobe);

}  // namespace lobelia
