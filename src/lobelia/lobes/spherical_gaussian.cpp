// Scalar side of the spherical-Gaussian kernels; products, sampling and merging (docs/lobes.md).
#include "lobelia/lobes/spherical_gaussian.h"

#include <limits>

#include "lobelia/base/frame.h"
#include "lobelia/lobes/kernels-inl.h"

namespace lobelia::lobes {
namespace {

core::V3<float> v3(Vec3f v) { return {v.x, v.y, v.z}; }

// A3(k) = coth k - 1/k and its derivative 1 - A3^2 - 2 A3/k. Below 0.1 the difference cancels: the
// series of the Langevin function, whose next term is below 1e-10 there.
struct Resultant {
  double value, derivative;
};
Resultant resultant(double k) {
  if (k < 0.1) {
    const double q = k * k;
    return {k * (1.0 / 3 - q * (1.0 / 45 - q * (2.0 / 945 - q / 4725))),
            1.0 / 3 - q * (1.0 / 15 - q * (2.0 / 189 - q / 675))};
  }
  const double r = 1 / std::tanh(k) - 1 / k;
  // For sharp lobes the derivative's terms cancel too: it is 1/k^2 - 1/sinh^2 k.
  const double s = k < 300 ? 1 / std::sinh(k) : 0;
  return {r, 1 / (k * k) - s * s};
}

}  // namespace

float gaussian(Vec3f axis, float sharpness, Vec3f w) {
  return core::gaussian(v3(axis), sharpness, v3(w));
}

float evaluate(const SphericalGaussian& g, Vec3f w) {
  return g.amplitude * gaussian(g.axis, g.sharpness, w);
}

float integral(float sharpness) { return core::sgIntegral(sharpness); }

SphericalGaussian product(const SphericalGaussian& a, const SphericalGaussian& b) {
  const Vec3f v = a.axis * a.sharpness + b.axis * b.sharpness;
  const Vec3f d = a.axis - b.axis;
  const float sharpness = length(v);
  const float sum = sharpness + a.sharpness + b.sharpness;
  SphericalGaussian p;
  p.sharpness = sharpness;
  // Opposite lobes of equal sharpness give a constant, which has no axis.
  p.axis = sharpness > 0 ? v / sharpness : a.axis;
  const float g = sum > 0 ? -a.sharpness * b.sharpness * lengthSquared(d) / sum : 0.f;
  p.amplitude = a.amplitude * b.amplitude * std::exp(g);
  return p;
}

float productIntegral(const SphericalGaussian& a, const SphericalGaussian& b) {
  return a.amplitude * b.amplitude *
         core::sgProductIntegral(v3(a.axis), a.sharpness, v3(b.axis), b.sharpness);
}

double meanResultant(double kappa) { return resultant(kappa).value; }
float meanResultant(float kappa) {
  return static_cast<float>(meanResultant(static_cast<double>(kappa)));
}

// Banerjee's estimate, then Newton steps: relative error below 1e-5 after two, third for safety.
double inverseMeanResultant(double r) {
  if (!(r > 0)) return 0;
  if (r >= 1) return std::numeric_limits<double>::infinity();
  double k = r * (3 - r * r) / ((1 - r) * (1 + r));
  for (int i = 0; i < 3; ++i) {
    const Resultant at = resultant(k);
    k = std::max(k - (at.value - r) / at.derivative, 0.1 * k);
  }
  return k;
}
float inverseMeanResultant(float r) {
  return static_cast<float>(inverseMeanResultant(static_cast<double>(r)));
}

float hemisphereIntegral(float cosine, float sharpness) {
  return core::sgHemisphereIntegral(cosine, sharpness);
}

float cosineIntegral(float cosine, float sharpness) {
  return core::sgCosineIntegral(cosine, sharpness);
}

float clippedPeak(float cosine, float sharpness) {
  return 1 / std::max(hemisphereIntegral(cosine, sharpness), 0.05f * integral(sharpness));
}

float vmfPdf(Vec3f axis, float kappa, Vec3f w) {
  return gaussian(axis, kappa, w) / integral(kappa);
}

Vec3f sampleVmf(Vec3f axis, float kappa, Vec2f u) {
  // t = 1 - cos by inversion, exact for every kappa > 0; [P002 eq. 8] drops e^(-2 kappa).
  const float t = kappa > 1e-6f ? -std::log1p(u.x * std::expm1(-2 * kappa)) / kappa : 2 * u.x;
  const float sine = std::sqrt(std::max(0.f, t * (2 - t)));
  const float phi = kTwoPi * u.y;
  return frameFromNormal(axis).toWorld({sine * std::cos(phi), sine * std::sin(phi), 1 - t});
}

Moment momentOf(Vec3f axis, float kappa, float energy) {
  return {energy, axis * (energy * meanResultant(kappa))};
}

SphericalGaussian lobeOf(const Moment& m, float maxKappa) {
  const float len = length(m.first);
  SphericalGaussian g;
  if (m.weight > 0 && len > 0) {
    g.axis = m.first / len;
    g.sharpness = std::min(inverseMeanResultant(len / m.weight), maxKappa);
  }
  g.amplitude = m.weight / integral(g.sharpness);
  return g;
}

}  // namespace lobelia::lobes
