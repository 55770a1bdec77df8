// A clear sky computed, not fitted. For each of 22 wavelengths:
//  - Air molecules scatter with the optical depth of Hansen and Travis 1974 ("Light scattering in
//    planetary atmospheres", eq. 2.30), exponential in altitude with a scale height of 8 km.
//  - Haze follows Angstrom's law with the exponent 1.3 and the coefficient that Preetham, Shirley
//    and Smits 1999 ("A Practical Analytic Model for Daylight", appendix 2) give for a turbidity,
//    0.04608 T - 0.04586; scale height 1.2 km, phase function of Henyey and Greenstein with
//    g = 0.7, 5 % of what it takes is absorbed (typical continental aerosol).
//  - Ozone, 0.3 cm at 22 +- 5 km, absorbs by the Chappuis band, here a Gaussian of 0.13 per cm at
//    593 nm, sigma 50 nm.
//  - Sunlight above the atmosphere: means over 20 nm of the standard extraterrestrial spectrum
//    (Wehrli 1985; ASTM E490), 133 klx.
// Light scattered once is integrated along the ray through spherical shells, with the shadow of the
// earth. Light scattered more often comes from a plane-parallel atmosphere lit by the spherical
// one's sunlight (the "pseudo-spherical" approximation, Dahlback and Stamnes 1991), by successive
// orders of scattering in 24 directions, averaged over the azimuth; the ground reflects diffusely.
//
// Deviations from nature: no refraction, no airglow or moon, no polarisation, no limb darkening.
// Mitsuba's sky evaluates a fit (Hosek and Wilkie 2012) to path traced results for another
// atmosphere: another phase function of haze, which makes the aureole, and other haze for the same
// turbidity. Its numbers are not ours; most so near the sun and the horizon. What ours agree with
// is in tests/io/sky_test.cpp: illuminance of the IESNA's clear day (sun within 10 %, sky within 35
// %, it is brighter), luminance of the CIE's clear sky (within a factor 1.6), twilight. This one
// also goes on when the sun has set.
#include "lobelia/io/atmosphere.h"

#include "lobelia/base/parallel.h"
#include "lobelia/io/atmosphere_air.h"
#include "lobelia/io/spectrum.h"

namespace lobelia::io {

using namespace air;

namespace {

// Nodes and weights of Gauss and Legendre on [0, 1].
void gaussLegendre(size_t n, double* x, double* w) {
  for (size_t i = 0; i < n; ++i) {
    double z = std::cos(kPiD * (static_cast<double>(i) + 0.75) / (static_cast<double>(n) + 0.5));
    double derivative = 1;
    for (int iteration = 0; iteration < 50; ++iteration) {
      double p = 1, before = 0;
      for (size_t k = 0; k < n; ++k) {
        const double order = static_cast<double>(k);
        const double next = ((2 * order + 1) * z * p - order * before) / (order + 1);
        before = p, p = next;
      }
      derivative = static_cast<double>(n) * (z * p - before) / (z * z - 1);
      const double step = p / derivative;
      z -= step;
      if (std::abs(step) < 1e-15) break;
    }
    x[i] = 0.5 * (1 - z);
    w[i] = 1 / ((1 - z * z) * derivative * derivative);
  }
}

// An albedo of three colours as a spectrum of three boxes.
double albedoAt(Rgb albedo, double nanometres) {
  return static_cast<double>(nanometres < 490 ? albedo.z : nanometres < 590 ? albedo.y : albedo.x);
}

}  // namespace

const Atmosphere::Spectral& Atmosphere::solarSpectrum() {
  static constexpr Spectral kSun{1.07, 1.18, 1.55, 1.72, 1.83, 2.05, 2.04, 1.92, 1.86, 1.88, 1.83,
                                 1.84, 1.77, 1.69, 1.62, 1.54, 1.48, 1.42, 1.36, 1.29, 1.24, 1.19};
  return kSun;
}

Atmosphere::Atmosphere(const AtmosphereSettings& settings)
    : settings_(settings), sunCosine_(std::sin(settings.sunElevation)) {
  const double angstrom = std::max(0.0, 0.04608 * settings.turbidity - 0.04586);
  double yIntegral = 0;
  for (double l = 360; l <= 830; l += 5) yIntegral += 5 * cie1931(l).y;
  for (size_t i = 0; i < kWavelengths; ++i) {
    const double um = wavelength(i) / 1000, um2 = um * um;
    rayleigh_[i] = 0.008569 / (um2 * um2) * (1 + 0.0113 / um2 + 0.00013 / (um2 * um2));
    hazeExtinction_[i] = angstrom * std::pow(um, -1.3);
    const double x = (wavelength(i) - 593) / 50;
    ozone_[i] = 0.3 * 0.13 * std::exp(-0.5 * x * x);
    Vec3d xyz;  // of a hat function
    for (double d = -20; d <= 20; d += 5)
      xyz += cie1931(wavelength(i) + d) * (5 * (1 - std::abs(d) / 20));
    toRgb_[i] = xyzToRgb(xyz / yIntegral);
  }
  for (size_t k = 0; k <= kLevels; ++k) {
    const double x = static_cast<double>(k) / kLevels;
    altitudes_[k] = kTop * x * x;
  }
  double ozone = 0;
  for (double h = 0.5; h < kTop; ++h) ozone += ozoneDensity(h);
  ozoneNorm_ = 1 / ozone;
  makeTable();
  constexpr size_t kHalf = kStreams / 2;
  double x[kHalf], w[kHalf];
  gaussLegendre(kHalf, x, w);
  for (size_t j = 0; j < kHalf; ++j) {
    mu_[j] = -x[j], mu_[kHalf + j] = x[j];
    weight_[j] = weight_[kHalf + j] = w[j];
  }

  // The disc in strips, so that the sun sets little by little.
  Spectral sun{}, flux{}, sky{}, reflected{};
  constexpr int kStrips = 16;
  for (int s = 0; s < kStrips; ++s) {
    const double y = (s + 0.5) / kStrips * 2 - 1;
    const double share = std::sqrt(1 - y * y) * 4 / (kPiD * kStrips);
    bool blocked;
    const Columns columns =
        towardsSun(0, std::sin(settings.sunElevation + y * settings.sunRadius), &blocked);
    if (blocked) continue;
    for (size_t i = 0; i < kWavelengths; ++i)
      sun[i] += share * solarSpectrum()[i] * std::exp(-depth(i, columns));
  }
  sun_ = toRgb(sun);

  fields_.resize(kWavelengths);
  parallelFor(kWavelengths, 1,
              [&](size_t i) { solve(i, albedoAt(settings_.albedo, wavelength(i))); });
  for (size_t i = 0; i < kWavelengths; ++i) {
    for (size_t j = 0; j < kHalf; ++j) sky[i] -= 2 * kPiD * weight_[j] * mu_[j] * fields_[i][0][j];
    flux[i] = sky[i] + sun[i] * std::max(0.0, sunCosine_);
    reflected[i] = flux[i] * albedoAt(settings_.albedo, wavelength(i)) / kPiD;
  }
  sky_ = toRgb(sky), ground_ = toRgb(flux), reflected_ = toRgb(reflected);
}

double Atmosphere::depth(size_t i, const Columns& c) const {
  return rayleigh_[i] * c.rayleigh + hazeExtinction_[i] * c.haze + ozone_[i] * c.ozone;
}

// Colours out of gamut (a sun at the horizon is more than red) are clamped.
Rgb Atmosphere::toRgb(const Spectral& spectrum) const {
  Vec3d sum;
  for (size_t i = 0; i < kWavelengths; ++i) sum += toRgb_[i] * spectrum[i];
  const auto clamped = [](double v) { return static_cast<float>(std::max(v, 0.0)); };
  return {clamped(sum.x), clamped(sum.y), clamped(sum.z)};
}

// Steps grow away from the start and are short where the ray is low.
Atmosphere::Columns Atmosphere::integrate(double altitude, double cosine) const {
  constexpr int kSteps = 48;
  const double r = kEarth + altitude, way = wayToTop(altitude, cosine);
  // Rays that go down first are densest at their lowest point.
  const double lowest = cosine < 0 ? -r * cosine : 0;
  Columns sum;
  const auto leg = [&](double from, double to) {
    double before = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const double x = static_cast<double>(i) / kSteps, end = (to - from) * x * x * x;
      const double h = altitudeAt(altitude, cosine, from + 0.5 * (before + end));
      const double length = std::abs(end - before);
      sum.rayleigh += length * airDensity(h);
      sum.haze += length * hazeDensity(h);
      sum.ozone += length * ozoneDensity(h) * ozoneNorm_;
      before = end;
    }
  };
  if (lowest > 0) leg(lowest, 0);
  leg(lowest, way);
  return sum;
}

void Atmosphere::makeTable() {
  table_.resize((kLevels + 1) * kAngles);
  sunlight_.resize(table_.size());
  parallelFor(kLevels + 1, 1, [&](size_t k) {
    const double horizon = horizons_[k] = std::asin(horizonCosine(altitudes_[k]));
    for (size_t a = 0; a < kAngles; ++a) {
      const double x = static_cast<double>(a) / (kAngles - 1);
      const double elevation = horizon + (0.5 * kPiD - horizon) * x * x;
      const size_t index = k * kAngles + a;
      table_[index] = integrate(altitudes_[k], std::sin(elevation));
      for (size_t i = 0; i < kWavelengths; ++i)
        sunlight_[index][i] = solarSpectrum()[i] * std::exp(-depth(i, table_[index]));
    }
  });
}

// The four entries of the table around a place, with their weights. Angles count from each level's
// own horizon.
std::array<Atmosphere::Entry, 4> Atmosphere::entries(double altitude, double cosine) const {
  const double elevation = std::asin(std::clamp(cosine, -1.0, 1.0));
  const double level = kLevels * std::sqrt(std::clamp(altitude / kTop, 0.0, 1.0));
  const size_t k = std::min(static_cast<size_t>(level), kLevels - 1);
  const double f = level - static_cast<double>(k);
  std::array<Entry, 4> result;
  for (size_t row = 0; row < 2; ++row) {
    const double horizon = horizons_[k + row];
    const double x =
        std::sqrt(std::clamp((elevation - horizon) / (0.5 * kPiD - horizon), 0.0, 1.0)) *
        (kAngles - 1);
    const size_t a = std::min(static_cast<size_t>(x), kAngles - 2);
    const double g = x - static_cast<double>(a), share = row == 0 ? 1 - f : f;
    const size_t index = (k + row) * kAngles + a;
    result[2 * row] = {index, share * (1 - g)};
    result[2 * row + 1] = {index + 1, share * g};
  }
  return result;
}

Atmosphere::Columns Atmosphere::towardsSun(double altitude, double cosine, bool* blocked) const {
  *blocked = cosine < horizonCosine(altitude);
  Columns sum;
  if (*blocked) return sum;
  for (const Entry& e : entries(altitude, cosine)) {
    const Columns& c = table_[e.index];
    sum.rayleigh += e.weight * c.rayleigh;
    sum.haze += e.weight * c.haze;
    sum.ozone += e.weight * c.ozone;
  }
  return sum;
}

std::vector<Rgb> Atmosphere::radiance(double cosZenith, std::span<const double> azimuths) const {
  constexpr int kSteps = 40;
  // What does not depend on the azimuth: the ray's steps, and light scattered more than once.
  struct Step {
    double way, altitude, length;
    Columns columns;               // from the ground to the middle of the step
    double air, haze;              // amounts per length
    Spectral multiple, keptLight;  // scattered more than once towards the ground; transmittance
  };
  std::array<double, kStreams> airTo, hazeTo;
  double airSum = 0, hazeSum = 0;
  for (size_t j = 0; j < kStreams; ++j) {
    airTo[j] = weight_[j] * azimuthMean(rayleighPhase, -cosZenith, mu_[j]);
    hazeTo[j] = weight_[j] * azimuthMean(hazePhase, -cosZenith, mu_[j]);
    airSum += airTo[j], hazeSum += hazeTo[j];
  }
  std::vector<Step> steps(kSteps);
  const double way = wayToTop(0, cosZenith);
  double before = 0;
  Columns passed;
  for (int s = 0; s < kSteps; ++s) {
    Step& step = steps[static_cast<size_t>(s)];
    const double x = static_cast<double>(s + 1) / kSteps, end = way * x * x * x;
    step.length = end - before;
    step.way = 0.5 * (before + end);
    step.altitude = altitudeAt(0, cosZenith, step.way);
    before = end;
    step.air = airDensity(step.altitude), step.haze = hazeDensity(step.altitude);
    const Columns amount{step.air * step.length, step.haze * step.length,
                         ozoneDensity(step.altitude) * ozoneNorm_ * step.length};
    step.columns = {passed.rayleigh + 0.5 * amount.rayleigh, passed.haze + 0.5 * amount.haze,
                    passed.ozone + 0.5 * amount.ozone};
    passed = {passed.rayleigh + amount.rayleigh, passed.haze + amount.haze,
              passed.ozone + amount.ozone};
    const double level = kLevels * std::sqrt(std::clamp(step.altitude / kTop, 0.0, 1.0));
    const size_t k = std::min(static_cast<size_t>(level), kLevels - 1);
    const double f = level - static_cast<double>(k);
    for (size_t i = 0; i < kWavelengths; ++i) {
      double fromAir = 0, fromHaze = 0;
      for (size_t j = 0; j < kStreams; ++j) {
        const double radiance = fields_[i][k][j] + (fields_[i][k + 1][j] - fields_[i][k][j]) * f;
        fromAir += airTo[j] * radiance, fromHaze += hazeTo[j] * radiance;
      }
      // The mean of exp(-depth) over the step, not its value in the middle.
      const double own = depth(i, amount);
      step.keptLight[i] = std::exp(-depth(i, step.columns) + 0.5 * own) *
                          (own > 1e-6 ? (1 - std::exp(-own)) / own : 1.0) * step.length;
      step.multiple[i] = rayleigh_[i] * step.air * fromAir / airSum +
                         kHazeAlbedo * hazeExtinction_[i] * step.haze * fromHaze / hazeSum;
    }
  }

  const double sinZenith = std::sqrt(std::max(0.0, 1 - cosZenith * cosZenith));
  const double sunSine = std::sqrt(std::max(0.0, 1 - sunCosine_ * sunCosine_));
  std::vector<Rgb> result;
  result.reserve(azimuths.size());
  for (const double azimuth : azimuths) {
    const double toSun = cosZenith * sunCosine_ + sinZenith * sunSine * std::cos(azimuth);
    const double airPhase = rayleighPhase(toSun) / (4 * kPiD);
    const double hazeFactor = kHazeAlbedo * hazePhase(toSun) / (4 * kPiD);
    Spectral sum{};
    for (const Step& step : steps) {
      const double cosine = (kEarth * sunCosine_ + step.way * toSun) / (kEarth + step.altitude);
      Spectral sun{};
      if (cosine >= horizonCosine(step.altitude)) {
        for (const Entry& e : entries(step.altitude, cosine)) {
          const Spectral& entry = sunlight_[e.index];
          for (size_t i = 0; i < kWavelengths; ++i) sun[i] += e.weight * entry[i];
        }
      }
      const double air = step.air * airPhase, haze = step.haze * hazeFactor;
      for (size_t i = 0; i < kWavelengths; ++i) {
        const double once = sun[i] * (rayleigh_[i] * air + hazeExtinction_[i] * haze);
        sum[i] += (step.multiple[i] + once) * step.keptLight[i];
      }
    }
    result.push_back(toRgb(sum));
  }
  return result;
}

}  // namespace lobelia::io
