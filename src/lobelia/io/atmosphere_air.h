// What the computed sky's air is made of (atmosphere.cpp gives the sources), and ways through its
// spherical shells. Altitudes and lengths in km.
#pragma once

#include <algorithm>
#include <cmath>

namespace lobelia::io::air {

inline constexpr double kPiD = 3.14159265358979323846;
inline constexpr double kEarth = 6371, kTop = 70;  // km
inline constexpr double kAirHeight = 8, kHazeHeight = 1.2, kOzoneAltitude = 22, kOzoneWidth = 5;
inline constexpr double kHazeAsymmetry = 0.7, kHazeAlbedo = 0.95;

inline double rayleighPhase(double c) { return 0.75 * (1 + c * c); }
inline double hazePhase(double c) {
  constexpr double g = kHazeAsymmetry;
  const double d = 1 + g * g - 2 * g * c;
  return (1 - g * g) / (d * std::sqrt(d));
}

// Densities whose vertical integral is one (ozone's: once divided by its own integral).
inline double airDensity(double h) { return std::exp(-h / kAirHeight) / kAirHeight; }
inline double hazeDensity(double h) { return std::exp(-h / kHazeHeight) / kHazeHeight; }
inline double ozoneDensity(double h) {
  const double x = (h - kOzoneAltitude) / kOzoneWidth;
  return std::exp(-0.5 * x * x);
}

// Way to the top of the atmosphere (or, from above ground, past the earth).
inline double wayToTop(double altitude, double cosine) {
  const double r = kEarth + altitude, b = r * cosine;
  const double top = kEarth + kTop;
  return std::max(0.0, -b + std::sqrt(std::max(0.0, b * b + top * top - r * r)));
}
inline double altitudeAt(double altitude, double cosine, double t) {
  const double r = kEarth + altitude;
  // sqrt(r^2 + 2 r t c + t^2) - R without cancellation.
  const double x = (2 * r * t * cosine + t * t + altitude * (2 * kEarth + altitude)) / kEarth;
  return std::max(0.0, x / (1 + std::sqrt(1 + x / kEarth)));
}
inline double horizonCosine(double altitude) {
  const double s = kEarth / (kEarth + altitude);
  return -std::sqrt(std::max(0.0, 1 - s * s));
}

// Mean over the azimuth of a phase function between propagation cosines a and b.
template <class Phase>
double azimuthMean(const Phase& phase, double a, double b) {
  constexpr int kSteps = 64;
  const double s = std::sqrt(std::max(0.0, (1 - a * a) * (1 - b * b)));
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += phase(a * b + s * std::cos((i + 0.5) * kPiD / kSteps));
  return sum / kSteps;
}

}  // namespace lobelia::io::air
