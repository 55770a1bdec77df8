// Light scattered more than once in the computed sky: successive orders of scattering between plane
// layers in discrete directions (atmosphere.cpp has the sources).
#include "lobelia/io/atmosphere.h"
#include "lobelia/io/atmosphere_air.h"

namespace lobelia::io {

using namespace air;

// Successive orders: each pass scatters the field of the last one and carries the result through
// the layers; the sum converges like a geometric series in the albedo.
void Atmosphere::solve(size_t wavelength, double albedo) {
  constexpr size_t kHalf = kStreams / 2;
  using Matrix = std::array<std::array<double, kStreams>, kStreams>;
  Matrix air, haze;
  std::array<double, kStreams> airFromSun, hazeFromSun;
  for (size_t i = 0; i < kStreams; ++i) {
    double airSum = 0, hazeSum = 0;
    for (size_t j = 0; j < kStreams; ++j) {
      air[i][j] = weight_[j] * azimuthMean(rayleighPhase, mu_[i], mu_[j]);
      haze[i][j] = weight_[j] * azimuthMean(hazePhase, mu_[i], mu_[j]);
      airSum += air[i][j], hazeSum += haze[i][j];
    }
    for (size_t j = 0; j < kStreams; ++j) air[i][j] /= airSum, haze[i][j] /= hazeSum;
    airFromSun[i] = azimuthMean(rayleighPhase, mu_[i], -sunCosine_);
    hazeFromSun[i] = azimuthMean(hazePhase, mu_[i], -sunCosine_);
  }

  // Layer k lies between levels k and k + 1.
  std::array<double, kLevels> airDepth, hazeDepth, total, beam;
  for (size_t k = 0; k < kLevels; ++k) {
    const double lo = altitudes_[k], hi = altitudes_[k + 1], middle = 0.5 * (lo + hi);
    airDepth[k] = rayleigh_[wavelength] * (std::exp(-lo / kAirHeight) - std::exp(-hi / kAirHeight));
    const double taken =
        hazeExtinction_[wavelength] * (std::exp(-lo / kHazeHeight) - std::exp(-hi / kHazeHeight));
    hazeDepth[k] = kHazeAlbedo * taken;
    total[k] = airDepth[k] + taken +
               ozone_[wavelength] * ozoneDensity(middle) * ozoneNorm_ * (hi - lo) + 1e-12;
    bool blocked;
    const Columns columns = towardsSun(middle, sunCosine_, &blocked);
    beam[k] =
        blocked ? 0
                : solarSpectrum()[wavelength] * std::exp(-depth(wavelength, columns)) / (4 * kPiD);
  }
  bool set;
  const Columns columns = towardsSun(0, sunCosine_, &set);
  const double direct = set || sunCosine_ <= 0 ? 0
                                               : sunCosine_ * solarSpectrum()[wavelength] *
                                                     std::exp(-depth(wavelength, columns));

  Field& field = fields_[wavelength];
  for (auto& level : field) level.fill(0);
  for (int order = 0; order < 200; ++order) {
    std::array<std::array<double, kStreams>, kLevels> source;
    for (size_t k = 0; k < kLevels; ++k) {
      for (size_t i = 0; i < kStreams; ++i) {
        double fromAir = airFromSun[i] * beam[k], fromHaze = hazeFromSun[i] * beam[k];
        for (size_t j = 0; j < kStreams; ++j) {
          const double radiance = 0.5 * (field[k][j] + field[k + 1][j]);
          fromAir += air[i][j] * radiance;
          fromHaze += haze[i][j] * radiance;
        }
        source[k][i] = (airDepth[k] * fromAir + hazeDepth[k] * fromHaze) / total[k];
      }
    }
    double change = 0, largest = 0, flux = direct;
    const auto update = [&](double* value, double now) {
      change = std::max(change, std::abs(now - *value));
      largest = std::max(largest, now);
      *value = now;
    };
    for (size_t j = 0; j < kHalf; ++j) {
      update(&field[kLevels][j], 0);
      for (size_t k = kLevels; k-- > 0;) {
        const double kept = std::exp(total[k] / mu_[j]);
        update(&field[k][j], field[k + 1][j] * kept + source[k][j] * (1 - kept));
      }
      flux -= 2 * kPiD * weight_[j] * mu_[j] * field[0][j];
    }
    for (size_t j = kHalf; j < kStreams; ++j) {
      update(&field[0][j], albedo * flux / kPiD);
      for (size_t k = 0; k < kLevels; ++k) {
        const double kept = std::exp(-total[k] / mu_[j]);
        update(&field[k + 1][j], field[k][j] * kept + source[k][j] * (1 - kept));
      }
    }
    if (change <= 1e-5 * largest) break;
  }
}

}  // namespace lobelia::io
