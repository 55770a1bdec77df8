// Spectra to linear sRGB, as an RGB renderer needs them.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/error.h"
#include "lobelia/base/vec.h"

namespace lobelia::io {

// What a spectrum stands for decides which values are in gamut: reflectances lie in [0, 1],
// emission and optical constants are only bounded below by 0.
enum class SpectrumUse { reflectance, emission, unbounded };

// Samples joined by straight lines, zero outside. Wavelengths in nanometres, increasing.
struct Spectrum {
  std::vector<double> wavelengths, values;
};

// The CIE 1931 2-degree colour matching functions, linear between values tabulated every 5 nm
// from 360 to 830 nm; zero outside.
Vec3d cie1931(double nanometres);
// Linear sRGB (Rec. 709 primaries, D65 white) of XYZ.
Vec3d xyzToRgb(Vec3d xyz);
// Scaled so that the constant spectrum 1 has Y = 1. No adaptation of the white point: a constant
// spectrum is E-white, slightly reddish in sRGB, as in Mitsuba 3's rgb variants. Values out of
// gamut for `use` are clamped, and then *clamped is set.
Rgb spectrumToRgb(const Spectrum& spectrum, SpectrumUse use, bool* clamped = nullptr);
// Radiance of a black body in W/(m^2 sr nm) by Planck's law, through spectrumToRgb.
Rgb blackbodyToRgb(double kelvin);

// Text file with "wavelength value" lines and # comments. Throws InputError.
Spectrum readSpectrum(const std::string& file, const Location& from);
// Throws InputError unless there are two samples or more with finite values, in increasing order.
void checkSpectrum(const Spectrum& spectrum, const Location& where);

}  // namespace lobelia::io
