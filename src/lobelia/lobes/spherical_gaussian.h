// Spherical Gaussians G(w) = amplitude exp(sharpness (axis.w - 1)) and von Mises-Fisher lobes:
// identities in their stable forms (docs/lobes.md).
#pragma once

#include <optional>

#include "lobelia/base/vec.h"

namespace lobelia::lobes {

struct SphericalGaussian {
  Vec3f axis{0, 0, 1};
  float sharpness = 0;
  float amplitude = 1;
};

float evaluate(const SphericalGaussian& g, Vec3f w);
// exp(sharpness (cos - 1)) by |axis - w|^2, exact for sharp lobes.
float gaussian(Vec3f axis, float sharpness, Vec3f w);
float integral(float sharpness);  // A = 2 pi (1 - e^(-2 sharpness)) / sharpness
SphericalGaussian product(const SphericalGaussian& a, const SphericalGaussian& b);
float productIntegral(const SphericalGaussian& a, const SphericalGaussian& b);
float meanResultant(float kappa);     // A3 = coth k - 1/k
float inverseMeanResultant(float r);  // kappa of a mean resultant r in [0,1)
// In float 1 - r, and with it kappa, is lost for kappa above 1e5; sums of lobes need these.
double meanResultant(double kappa);
double inverseMeanResultant(double r);
// integral of exp(sharpness(axis.w-1)) over the hemisphere with normal at cosine c to the axis
float hemisphereIntegral(float cosine, float sharpness);  // Tokuyoshi 2022 form, error <= .0044 A
float cosineIntegral(float cosine, float sharpness);      // times [n.w]+; Tokuyoshi et al. 2024
// Amplitude per unit of what a Gaussian has above the horizon, at most 20 times what it would be
// for the whole.
float clippedPeak(float cosine, float sharpness);
double hemisphereIntegralExact(double cosine, double sharpness,
                               int cosinePower);  // quadrature oracle

float vmfPdf(Vec3f axis, float kappa, Vec3f w);
Vec3f sampleVmf(Vec3f axis, float kappa, Vec2f u);

// Additive moment of weighted lobes; the merge of lobes is the lobe of the sum of their moments.
struct Moment {
  float weight = 0;  // energy
  Vec3f first{};     // sum of weight * meanResultant(kappa) * axis
  void add(const Moment& m) { weight += m.weight, first += m.first; }
};
Moment momentOf(Vec3f axis, float kappa, float energy);
SphericalGaussian lobeOf(const Moment& m,
                         float maxKappa = 1e7f);  // amplitude so that the energy is kept

}  // namespace lobelia::lobes
