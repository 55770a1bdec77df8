// Colours of PBRT files as linear sRGB: colour spaces, spectra, illuminants and materials by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/base/transform.h"
#include "lobelia/io/spectrum.h"

namespace lobelia::io::pbrt {

// RGB of one of PBRT's colour spaces to linear sRGB. Bradford adaptation is left out, as in PBRT:
// white of a space is the colour of its own white point.
class ColorSpace {
 public:
  ColorSpace() = default;  // sRGB
  static std::optional<ColorSpace> named(const std::string& name);
  static std::vector<std::string> names();
  // Negative components are clamped.
  Rgb toSrgb(Rgb c) const;

 private:
  bool isSrgb_ = true;
  Mat4 matrix_;
};

// What PBRT makes of the spectrum of a light: scaled to Y = 1 (the light's scale factor times the
// sensor's response), out-of-gamut components clamped.
Rgb lightColor(const Spectrum& spectrum);
Rgb blackbodyLightColor(double kelvin);
// A reflectance: white is (1, 1, 1).
Rgb reflectanceColor(const Spectrum& spectrum);

// stdillum-A, stdillum-D50, illum-acesD60 ... at Y = 1.
std::optional<Rgb> namedIlluminant(const std::string& name);
// metal-Cu-eta, metal-Cu-k ...
std::optional<Rgb> namedMetal(const std::string& name);
// Index of refraction at the d line (587.6 nm) of glass-BK7 ...
std::optional<float> namedGlass(const std::string& name);
std::vector<std::string> namedSpectra();

}  // namespace lobelia::io::pbrt
