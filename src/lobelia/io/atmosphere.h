// Clear-sky radiative transfer: what the sky and the sun look like from the ground.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::io {

struct AtmosphereSettings {
  double turbidity = 3;     // 1: no haze; 2: very clear, 3: clear, 6: warm and moist, 10: hazy
  double sunElevation = 1;  // radians; may be negative
  double sunRadius = 0.004654;
  Rgb albedo{0.3f};  // of the ground
};

// All radiances are scene-linear sRGB with Y the mean of spectral radiance in W m^-2 sr^-1 nm^-1
// under the eye's response, as in Mitsuba's rgb variants: luminance in cd/m^2 (illuminance in lux)
// is kLuminousEfficacy times Y.
inline constexpr double kLuminousEfficacy = 683.0 * 106.857;

class Atmosphere {
 public:
  static constexpr size_t kWavelengths = 22;  // 360, 380, ... 780 nm
  using Spectral = std::array<double, kWavelengths>;

  explicit Atmosphere(const AtmosphereSettings& settings);

  // Radiance of the sky without the sun's disc, for directions at one angle from the zenith (cosine
  // from 0 to 1) and azimuths from the sun's, in radians.
  std::vector<Rgb> radiance(double cosZenith, std::span<const double> azimuths) const;
  // Irradiance that the sun's disc gives a plane facing it; 0 when it has set.
  Rgb sunIrradiance() const { return sun_; }
  // Irradiance of the level ground by sun and sky, and by the sky alone; what the ground reflects.
  Rgb groundIrradiance() const { return ground_; }
  Rgb skyIrradiance() const { return sky_; }
  Rgb groundRadiance() const { return reflected_; }

  static double wavelength(size_t i) { return 360 + 20 * static_cast<double>(i); }  // nm
  // Irradiance above the atmosphere, W m^-2 nm^-1.
  static const Spectral& solarSpectrum();

 private:
  static constexpr size_t kLevels = 48;   // altitudes, level 0 on the ground
  static constexpr size_t kStreams = 24;  // directions of diffuse light, the first half downwards
  static constexpr size_t kAngles = 200;  // of the table of columns

  // Amounts along a path, in units of vertical ones: air molecules, haze, ozone.
  struct Columns {
    double rayleigh = 0, haze = 0, ozone = 0;
  };
  // Light that is scattered for the second time or more, per altitude and stream.
  using Field = std::array<std::array<double, kStreams>, kLevels + 1>;

  struct Entry {
    size_t index;
    double weight;
  };

  void makeTable();
  std::array<Entry, 4> entries(double altitude, double cosine) const;
  Columns integrate(double altitude, double cosine) const;
  Columns towardsSun(double altitude, double cosine, bool* blocked) const;
  void solve(size_t wavelength, double albedo);
  double depth(size_t wavelength, const Columns& columns) const;
  Rgb toRgb(const Spectral& spectrum) const;

  AtmosphereSettings settings_;
  double sunCosine_;
  double ozoneNorm_ = 1;
  Spectral rayleigh_, hazeExtinction_, ozone_;  // vertical optical depths
  std::array<Vec3d, kWavelengths> toRgb_;
  std::array<double, kLevels + 1> altitudes_;
  std::array<double, kLevels + 1> horizons_;  // angle of the earth's edge, seen from a level
  std::vector<Columns> table_;      // towards the sun, by level and angle above the level's horizon
  std::vector<Spectral> sunlight_;  // that arrives on these ways
  std::array<double, kStreams> mu_, weight_;  // of propagation, downwards negative
  std::vector<Field> fields_;                 // radiance of all diffuse light, per wavelength
  Rgb sun_, ground_, sky_, reflected_;
};

}  // namespace lobelia::io
