#include "lobelia/bsdf/microfacet_sampling.h"

#include <cmath>

#include "lobelia/base/frame.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr float kSqrtPi = 1.77245385090551603f;
constexpr float kLargestSlope = 5.4f;  // Gaussian slopes beyond have a probability of 1e-14

Vec3f sampleGgxVisible(float alphaX, float alphaY, Vec3f w, Vec2f u) {
  const Vec3f stretched = normalize(Vec3f(alphaX * w.x, alphaY * w.y, w.z));
  const float phi = kTwoPi * u.x;
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const float r = std::sqrt(std::clamp(1 - z * z, 0.f, 1.f));
  const Vec3f h = Vec3f(r * std::cos(phi), r * std::sin(phi), z) + stretched;
  return normalize(Vec3f(alphaX * h.x, alphaY * h.y, std::max(h.z, 1e-7f)));
}

// Slope along the plane of incidence as seen from elevation (sin, cos) for unit roughness: solves
// cos erfc(-s) + sin exp(-s^2) / sqrt(pi) = u * (its value at s = cot) by Newton's method within
// brackets.
float sampleBeckmannSlope(float sinTheta, float cosTheta, float u) {
  const float limit = cosTheta < kLargestSlope * sinTheta ? cosTheta / sinTheta : kLargestSlope;
  const float sine = sinTheta / kSqrtPi;
  const float atLimit = cosTheta * std::erfc(-limit) + sine * std::exp(-limit * limit);
  const float target = std::max(u, 1e-9f) * atLimit;
  float lo = -kLargestSlope, hi = limit;
  // Exact for grazing directions; close enough elsewhere to start from.
  const float edge = std::erf(limit);
  float s = inverseErf(edge - (edge + 1) * std::erf(std::sqrt(-std::log(std::max(u, 1e-9f)))));
  if (!(s > lo && s < hi)) s = 0.5f * (lo + hi);
  for (int i = 0; i < 24; ++i) {
    const float gauss = std::exp(-s * s);
    const float error = cosTheta * std::erfc(-s) + sine * gauss - target;
    (error > 0 ? hi : lo) = s;
    const float slope = 2 / kSqrtPi * gauss * (cosTheta - s * sinTheta);
    float next = s - error / slope;
    if (!(next > lo && next < hi)) next = 0.5f * (lo + hi);
    const float step = std::abs(next - s);
    s = next;
    if (step < 1e-4f) break;  // the error of a Newton step is the square of the one before
  }
  return s;
}

Vec3f sampleBeckmannVisible(float alphaX, float alphaY, Vec3f w, Vec2f u) {
  const Vec3f stretched = normalize(Vec3f(alphaX * w.x, alphaY * w.y, w.z));
  const float sinTheta = std::sqrt(stretched.x * stretched.x + stretched.y * stretched.y);
  const float cosPhi = sinTheta > 0 ? stretched.x / sinTheta : 1;
  const float sinPhi = sinTheta > 0 ? stretched.y / sinTheta : 0;
  const float along = sampleBeckmannSlope(sinTheta, stretched.z, u.x);
  const float across = inverseErf(2 * u.y - 1);
  const float slopeX = (cosPhi * along - sinPhi * across) * alphaX;
  const float slopeY = (sinPhi * along + cosPhi * across) * alphaY;
  return normalize(Vec3f(-slopeX, -slopeY, 1));
}

// Azimuth whose density is proportional to 1 / (a cos^2 + b sin^2).
float ellipticAzimuth(float a, float b, float u) {
  const float phi = kTwoPi * u;
  if (a == b) return phi;
  return std::atan2(std::sqrt(a) * std::sin(phi), std::sqrt(b) * std::cos(phi));
}

Vec3f samplePhong(float alphaX, float alphaY, Vec2f u) {
  const float a = std::max(2 / (alphaX * alphaX), 2.f), b = std::max(2 / (alphaY * alphaY), 2.f);
  const float phi = ellipticAzimuth(a, b, u.x);
  const float c = std::cos(phi), s = std::sin(phi);
  const float exponent = a * c * c + b * s * s;  // n(phi) + 2
  // cos = u^(1/exponent); the sine without cancellation.
  const float logCos = std::log(1 - u.y) / exponent;
  const float sinTheta = std::sqrt(std::max(0.f, -std::expm1(2 * logCos)));
  return {c * sinTheta, s * sinTheta, std::exp(logCos)};
}

Vec3f sampleGtr1(float alpha, Vec2f u) {
  const float phi = kTwoPi * u.x, a2 = alpha * alpha;
  // sin^2 = 1 - (1 - a2^(1-u)) / (1 - a2), without cancellation.
  const float sin2 = (std::pow(a2, 1 - u.y) - a2) / (1 - a2);
  const float s = std::sqrt(std::clamp(sin2, 0.f, 1.f));
  return {s * std::cos(phi), s * std::sin(phi), std::sqrt(std::clamp(1 - sin2, 0.f, 1.f))};
}

// von Mises-Fisher about the normal, its lower half left out.
Vec3f sampleSphericalGaussian(float alpha, Vec2f u) {
  const float sharpness = 2 / sqr(alpha);
  const float depth = -std::log1p(u.y * std::expm1(-sharpness)) / sharpness;  // 1 - cosine
  const float s = std::sqrt(std::clamp(depth * (2 - depth), 0.f, 1.f));
  const float phi = kTwoPi * u.x;
  return {s * std::cos(phi), s * std::sin(phi), std::max(1 - depth, 1e-7f)};
}

// The exact Smith term of Beckmann for one direction.
float beckmannMasking(float alphaX, float alphaY, Vec3f w) {
  const float t = std::sqrt(sqr(alphaX * w.x) + sqr(alphaY * w.y));
  if (t < 0.2f * w.z) return 1;  // 1 - 1e-12
  const float a = w.z / t;
  const float twice = 1 + std::erf(a) + std::exp(-a * a) / (a * kSqrtPi);
  return 2 / twice;
}

}  // namespace

// Giles 2010, "Approximating the erfinv function", single precision.
float inverseErf(float x) {
  const auto horner = [](float w, const float(&c)[9]) {
    float p = c[0];
    for (int i = 1; i < 9; ++i) p = p * w + c[i];
    return p;
  };
  static constexpr float kCentre[9] = {2.81022636e-08f,  3.43273939e-07f, -3.5233877e-06f,
                                       -4.39150654e-06f, 0.00021858087f,  -0.00125372503f,
                                       -0.00417768164f,  0.246640727f,    1.50140941f};
  static constexpr float kTail[9] = {-0.000200214257f, 0.000100950558f, 0.00134934322f,
                                     -0.00367342844f,  0.00573950773f,  -0.0076224613f,
                                     0.00943887047f,   1.00167406f,     2.83297682f};
  const float w = -std::log(std::max((1 - x) * (1 + x), 1e-14f));
  const float p = w < 5 ? horner(w - 2.5f, kCentre) : horner(std::sqrt(w) - 3, kTail);
  return std::clamp(p * x, -kLargestSlope, kLargestSlope);
}

Vec3f sampleMicroNormal(Distribution distribution, float alphaX, float alphaY, Vec3f w, Vec2f u) {
  switch (distribution) {
    case Distribution::beckmann:
      return sampleBeckmannVisible(alphaX, alphaY, w, u);
    case Distribution::phong:
      return samplePhong(alphaX, alphaY, u);
    case Distribution::gtr1:
      return sampleGtr1(alphaX, u);
    case Distribution::sphericalGaussian:
      return sampleSphericalGaussian(alphaX, u);
    case Distribution::ggx:
      break;
  }
  return sampleGgxVisible(alphaX, alphaY, w, u);
}

float microNormalPdf(Distribution distribution, float alphaX, float alphaY, Vec3f w, Vec3f m) {
  if (m.z <= 0) return 0;
  const float density = core::microfacetDensity(distribution, alphaX, alphaY, toCore(m));
  const float cosine = dot(w, m);
  switch (distribution) {
    case Distribution::phong:
    case Distribution::gtr1:
      return density * m.z;
    case Distribution::sphericalGaussian: {
      const float sharpness = 2 / sqr(alphaX);
      return density * core::sgProjectedIntegral(sharpness) / (kTwoPi * core::expRatio(sharpness));
    }
    case Distribution::beckmann:
      return density * beckmannMasking(alphaX, alphaY, w) * std::max(cosine, 0.f) / w.z;
    case Distribution::ggx:
      break;
  }
  return density * core::smithMasking(distribution, alphaX, alphaY, toCore(w)) *
         std::max(cosine, 0.f) / w.z;
}

}  // namespace lobelia
