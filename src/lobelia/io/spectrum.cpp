// Spectra to linear sRGB through the CIE 1931 standard observer (CIE 15:2004, table T.4).
//
// The integration rule (1000 points over 360..830 nm, both ends included, times range / 1000) is
// that of Mitsuba 3, so that scenes and reference images of that renderer agree to rounding; it
// differs from the exact integral by 0.1 %.

#include "lobelia/io/spectrum.h"

#include <fstream>
#include <sstream>

namespace lobelia::io {
namespace {

constexpr double kMinWavelength = 360, kMaxWavelength = 830, kStep = 5;
constexpr int kSampleCount = 95;
// Integral of the tabulated y-bar: normalises Y of the constant spectrum to 1.
constexpr double kYIntegral = 106.7502593994140625;

constexpr double kX[kSampleCount] = {
    0.0001299,      0.0002321,      0.0004149,      0.0007416,      0.001368,      0.002236,
    0.004243,       0.00765,        0.01431,        0.02319,        0.04351,       0.07763,
    0.13438,        0.21477,        0.2839,         0.3285,         0.34828,       0.34806,
    0.3362,         0.3187,         0.2908,         0.2511,         0.19536,       0.1421,
    0.09564,        0.05795001,     0.03201,        0.0147,         0.0049,        0.0024,
    0.0093,         0.0291,         0.06327,        0.1096,         0.1655,        0.2257499,
    0.2904,         0.3597,         0.4334499,      0.5120501,      0.5945,        0.6784,
    0.7621,         0.8425,         0.9163,         0.9786,         1.0263,        1.0567,
    1.0622,         1.0456,         1.0026,         0.9384,         0.8544499,     0.7514,
    0.6424,         0.5419,         0.4479,         0.3608,         0.2835,        0.2187,
    0.1649,         0.1212,         0.0874,         0.0636,         0.04677,       0.0329,
    0.0227,         0.01584,        0.01135916,     0.008110916,    0.005790346,   0.004109457,
    0.002899327,    0.00204919,     0.001439971,    0.0009999493,   0.0006900786,  0.0004760213,
    0.0003323011,   0.0002348261,   0.0001661505,   0.000117413,    0.00008307527, 0.00005870652,
    0.00004150994,  0.00002935326,  0.00002067383,  0.00001455977,  0.00001025398, 0.000007221456,
    0.000005085868, 0.000003581652, 0.000002522525, 0.000001776509, 0.000001251141};
constexpr double kY[kSampleCount] = {
    0.000003917,  0.000006965,  0.00001239,    0.00002202,    0.000039,     0.000064,
    0.00012,      0.000217,     0.000396,      0.00064,       0.00121,      0.00218,
    0.004,        0.0073,       0.0116,        0.01684,       0.023,        0.0298,
    0.038,        0.048,        0.06,          0.0739,        0.09098,      0.1126,
    0.13902,      0.1693,       0.20802,       0.2586,        0.323,        0.4073,
    0.503,        0.6082,       0.71,          0.7932,        0.862,        0.9148501,
    0.954,        0.9803,       0.9949501,     1.0,           0.995,        0.9786,
    0.952,        0.9154,       0.87,          0.8163,        0.757,        0.6949,
    0.631,        0.5668,       0.503,         0.4412,        0.381,        0.321,
    0.265,        0.217,        0.175,         0.1382,        0.107,        0.0816,
    0.061,        0.04458,      0.032,         0.0232,        0.017,        0.01192,
    0.00821,      0.005723,     0.004102,      0.002929,      0.002091,     0.001484,
    0.001047,     0.00074,      0.00052,       0.0003611,     0.0002492,    0.0001719,
    0.00012,      0.0000848,    0.00006,       0.0000424,     0.00003,      0.0000212,
    0.00001499,   0.0000106,    0.0000074657,  0.0000052578,  0.0000037029, 0.0000026078,
    0.0000018366, 0.0000012934, 0.00000091093, 0.00000064153, 0.00000045181};
constexpr double kZ[kSampleCount] = {
    0.0006061, 0.001086,   0.001946,    0.003486,    0.006450001, 0.01054999,    0.02005001,
    0.03621,   0.06785001, 0.1102,      0.2074,      0.3713,      0.6456,        1.0390501,
    1.3856,    1.62296,    1.74706,     1.7826,      1.77211,     1.7441,        1.6692,
    1.5281,    1.28764,    1.0419,      0.8129501,   0.6162,      0.46518,       0.3533,
    0.272,     0.2123,     0.1582,      0.1117,      0.07824999,  0.05725001,    0.04216,
    0.02984,   0.0203,     0.0134,      0.008749999, 0.005749999, 0.0039,        0.002749999,
    0.0021,    0.0018,     0.001650001, 0.0014,      0.0011,      0.001,         0.0008,
    0.0006,    0.00034,    0.00024,     0.00019,     0.0001,      0.00004999999, 0.00003,
    0.00002,   0.00001};

// Value at a wavelength; zero outside the samples.
double interpolate(const Spectrum& s, double wavelength) {
  if (wavelength < s.wavelengths.front() || wavelength > s.wavelengths.back()) return 0;
  const auto upper =
      std::upper_bound(s.wavelengths.begin() + 1, s.wavelengths.end() - 1, wavelength);
  const size_t i = static_cast<size_t>(upper - s.wavelengths.begin());
  const double w0 = s.wavelengths[i - 1], w1 = s.wavelengths[i];
  const double t = w1 > w0 ? (wavelength - w0) / (w1 - w0) : 1;
  return s.values[i - 1] * (1 - t) + s.values[i] * t;
}

template <class F>
Vec3d integrateRgb(F&& valueAt) {
  constexpr int kSteps = 1000;
  const double range = kMaxWavelength - kMinWavelength;
  Vec3d xyz;
  for (int i = 0; i < kSteps; ++i) {
    const double wavelength = kMinWavelength + range * i / (kSteps - 1);
    xyz += cie1931(wavelength) * valueAt(wavelength);
  }
  return xyzToRgb(xyz * (range / kSteps / kYIntegral));
}

}  // namespace

Vec3d cie1931(double nanometres) {
  const double t = (nanometres - kMinWavelength) / kStep;
  if (!(t >= 0) || t > kSampleCount - 1) return {};
  const int i = std::min(static_cast<int>(t), kSampleCount - 2);
  const double f = t - i;
  const auto mix = [&](const double* table) { return table[i] * (1 - f) + table[i + 1] * f; };
  return {mix(kX), mix(kY), mix(kZ)};
}

Vec3d xyzToRgb(Vec3d c) {
  return {3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z,
          -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z,
          0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z};
}

Rgb spectrumToRgb(const Spectrum& spectrum, SpectrumUse use, bool* clamped) {
  const Vec3d rgb = integrateRgb([&](double w) { return interpolate(spectrum, w); });
  Rgb out;
  bool outside = false;
  for (int c = 0; c < 3; ++c) {
    double v = std::max(rgb[c], 0.0);
    if (use == SpectrumUse::reflectance) v = std::min(v, 1.0);
    outside = outside || v != rgb[c];
    out[c] = static_cast<float>(v);
  }
  if (clamped) *clamped = outside;
  return out;
}

Rgb blackbodyToRgb(double kelvin) {
  constexpr double c = 2.99792458e8, h = 6.62607015e-34, k = 1.380649e-23;  // SI, exact
  const Vec3d rgb = integrateRgb([&](double nanometres) {
    const double w = nanometres * 1e-9;
    return 1e-9 * 2 * h * c * c / (std::pow(w, 5) * std::expm1(h * c / (w * k * kelvin)));
  });
  Rgb out;
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(std::max(rgb[i], 0.0));
  return out;
}

void checkSpectrum(const Spectrum& s, const Location& where) {
  if (s.wavelengths.size() < 2) {
    throw InputError(where,
                     "the spectrum has fewer than two samples; give two or more pairs of "
                     "wavelength and value");
  }
  for (size_t i = 0; i < s.wavelengths.size(); ++i) {
    if (!std::isfinite(s.wavelengths[i]) || !std::isfinite(s.values[i])) {
      throw InputError(where, "the spectrum has a value that is not finite");
    }
    if (i > 0 && s.wavelengths[i] < s.wavelengths[i - 1]) {
      throw InputError(where, "the spectrum's wavelengths do not increase; sort them");
    }
  }
}

Spectrum readSpectrum(const std::string& file, const Location& from) {
  std::ifstream in(file);
  if (!in) throw InputError(from, "cannot open the spectrum file '" + file + "'");
  Spectrum s;
  Location at{file, 0, 0};
  for (std::string line; std::getline(in, line);) {
    ++at.line;
    const size_t start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') continue;
    std::istringstream words(line);
    double wavelength = 0, value = 0;
    std::string rest;
    if (!(words >> wavelength >> value) || (words >> rest)) {
      throw InputError(at, "not a line of a spectrum; it should be 'wavelength value'");
    }
    s.wavelengths.push_back(wavelength);
    s.values.push_back(value);
  }
  checkSpectrum(s, {file, 0, 0});
  return s;
}

}  // namespace lobelia::io
