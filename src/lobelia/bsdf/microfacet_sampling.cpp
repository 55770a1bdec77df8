#include "lobelia/bsdf/microfacet_sampling.h"

#include <cmath>

#include "lobelia/base/frame.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr double kSqrtPi = 1.7724538509055160273;

Vec3f sampleGgxVisible(float alphaX, float alphaY, Vec3f w, Vec2f u) {
  const Vec3f stretched = normalize(Vec3f(alphaX * w.x, alphaY * w.y, w.z));
  const float phi = kTwoPi * u.x;
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const float r = std::sqrt(std::clamp(1 - z * z, 0.f, 1.f));
  const Vec3f h = Vec3f(r * std::cos(phi), r * std::sin(phi), z) + stretched;
  return normalize(Vec3f(alphaX * h.x, alphaY * h.y, std::max(h.z, 1e-7f)));
}

// Slope along the plane of incidence as seen from elevation (sin, cos) for unit roughness: solves
// cos (1 + erf s) + sin exp(-s^2) / sqrt(pi) = u * (its value at s = cot).
double sampleBeckmannSlope(double sinTheta, double cosTheta, double u) {
  const double limit = cosTheta < 5.8 * sinTheta ? cosTheta / sinTheta : 5.8;
  const auto cumulative = [&](double s) {
    return cosTheta * (1 + std::erf(s)) + sinTheta / kSqrtPi * std::exp(-s * s);
  };
  const double target = u * cumulative(limit);
  double lo = -5.8, hi = limit;
  // Exact for grazing directions; close enough elsewhere to start from.
  const double edge = std::erf(limit);
  double s = inverseErf(edge - (edge + 1) * std::erf(std::sqrt(-std::log(std::max(u, 1e-12)))));
  if (!(s > lo && s < hi)) s = 0.5 * (lo + hi);
  for (int i = 0; i < 40; ++i) {
    const double error = cumulative(s) - target;
    (error > 0 ? hi : lo) = s;
    const double slope = 2 / kSqrtPi * std::exp(-s * s) * (cosTheta - s * sinTheta);
    double next = s - error / slope;
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    const double step = std::abs(next - s);
    s = next;
    if (step < 1e-7) break;
  }
  return s;
}

Vec3f sampleBeckmannVisible(float alphaX, float alphaY, Vec3f w, Vec2f u) {
  const Vec3f stretched = normalize(Vec3f(alphaX * w.x, alphaY * w.y, w.z));
  const float sinTheta = std::sqrt(stretched.x * stretched.x + stretched.y * stretched.y);
  const float cosPhi = sinTheta > 0 ? stretched.x / sinTheta : 1;
  const float sinPhi = sinTheta > 0 ? stretched.y / sinTheta : 0;
  const float along = static_cast<float>(sampleBeckmannSlope(sinTheta, stretched.z, u.x));
  const float across = static_cast<float>(inverseErf(2.0 * u.y - 1.0));
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

// The exact Smith term of Beckmann for one direction.
float beckmannMasking(float alphaX, float alphaY, Vec3f w) {
  const float t = std::sqrt(sqr(alphaX * w.x) + sqr(alphaY * w.y));
  if (t < 0.2f * w.z) return 1;  // 1 - 1e-12
  const float a = w.z / t;
  const float twice = 1 + std::erf(a) + std::exp(-a * a) / (a * static_cast<float>(kSqrtPi));
  return 2 / twice;
}

}  // namespace

double inverseErf(double x) {
  if (x <= -1 + 1e-15) return -5.8;
  if (x >= 1 - 1e-15) return 5.8;
  // Winitzki 2008 (0.2 %), then two Newton steps (Halley's correction).
  const double ln = std::log1p(-x * x);
  const double t = 2 / (3.14159265358979 * 0.147) + 0.5 * ln;
  double y = std::copysign(std::sqrt(std::sqrt(t * t - ln / 0.147) - t), x);
  for (int i = 0; i < 2; ++i) {
    const double e = (std::erf(y) - x) * 0.5 * kSqrtPi * std::exp(y * y);
    y -= e / (1 + y * e);
  }
  return std::clamp(y, -5.8, 5.8);
}

Vec3f sampleMicroNormal(Distribution distribution, float alphaX, float alphaY, Vec3f w, Vec2f u) {
  switch (distribution) {
    case Distribution::beckmann:
      return sampleBeckmannVisible(alphaX, alphaY, w, u);
    case Distribution::phong:
      return samplePhong(alphaX, alphaY, u);
    case Distribution::gtr1:
      return sampleGtr1(alphaX, u);
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
    case Distribution::beckmann:
      return density * beckmannMasking(alphaX, alphaY, w) * std::max(cosine, 0.f) / w.z;
    case Distribution::ggx:
      break;
  }
  return density * core::smithMasking(distribution, alphaX, alphaY, toCore(w)) *
         std::max(cosine, 0.f) / w.z;
}

}  // namespace lobelia
