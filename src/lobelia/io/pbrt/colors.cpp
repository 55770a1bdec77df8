// Sources: chromaticities of standard illuminants from CIE 15:2004, tables T.3 and 11.1 (lights are
// scaled to Y = 1, so that nothing but the chromaticity is left of an illuminant); primaries from
// IEC 61966-2-1, ITU-R BT.2020, SMPTE ST 2065-1 and RP 431-2 with a D65 white; refractive indices
// from Schott's data sheets (n_d). Deviation: no dispersion, PBRT renders a spectrum.
#include "lobelia/io/pbrt/colors.h"

#include <cmath>

#include "lobelia/io/optical_constants.h"

namespace lobelia::io::pbrt {
namespace {

struct Chromaticity {
  double x, y;
};
Vec3d toXyz(Chromaticity c) { return {c.x / c.y, 1, (1 - c.x - c.y) / c.y}; }

struct Illuminant {
  const char* name;
  Chromaticity white;
};
constexpr Chromaticity kD65{0.31272, 0.32903};
constexpr Illuminant kIlluminants[] = {
    {"stdillum-A", {0.44758, 0.40745}},
    {"stdillum-D50", {0.34567, 0.35851}},
    {"stdillum-D65", kD65},
    {"stdillum-F1", {0.3131, 0.3371}},
    {"stdillum-F2", {0.3721, 0.3751}},
    {"stdillum-F3", {0.4091, 0.3941}},
    {"stdillum-F4", {0.4402, 0.4031}},
    {"stdillum-F5", {0.3138, 0.3452}},
    {"stdillum-F6", {0.3779, 0.3882}},
    {"stdillum-F7", {0.3129, 0.3292}},
    {"stdillum-F8", {0.3458, 0.3586}},
    {"stdillum-F9", {0.3741, 0.3727}},
    {"stdillum-F10", {0.3458, 0.3588}},
    {"stdillum-F11", {0.3805, 0.3769}},
    {"stdillum-F12", {0.4370, 0.4042}},
    {"illum-acesD60", {0.32168, 0.33767}},
};

struct Glass {
  const char* name;
  float index;
};
constexpr Glass kGlasses[] = {
    {"glass-BK7", 1.51680f},   {"glass-BAF10", 1.67003f}, {"glass-FK51A", 1.48656f},
    {"glass-LASF9", 1.85025f}, {"glass-F5", 1.67271f},    {"glass-F10", 1.72825f},
    {"glass-F11", 1.78472f},
};

// Brass, after the measurements of Querry 1985, to three digits.
constexpr Rgb kBrassEta{0.444f, 0.527f, 1.094f}, kBrassK{3.695f, 2.765f, 1.829f};
constexpr const char* kMetals[] = {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"};

Rgb clamped(Vec3d c) {
  Rgb out;
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(std::max(c[i], 0.0));
  return out;
}

struct Primaries {
  const char* name;
  Chromaticity r, g, b, white;
};
constexpr Primaries kSpaces[] = {
    {"srgb", {0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, kD65},
    {"rec2020", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65},
    {"aces2065-1", {0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}},
    {"dci-p3", {0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65},
};

Mat4 columns(Vec3d a, Vec3d b, Vec3d c) {
  Mat4 m;
  for (size_t i = 0; i < 3; ++i) {
    const int k = static_cast<int>(i);
    m.m[i] = {a[k], b[k], c[k], 0};
  }
  return m;
}

Vec3d times(const Mat4& m, Vec3d v) {
  Vec3d out;
  for (size_t i = 0; i < 3; ++i)
    out[static_cast<int>(i)] = m.m[i][0] * v.x + m.m[i][1] * v.y + m.m[i][2] * v.z;
  return out;
}

// XYZ of a space's RGB: the primaries weighted so that (1, 1, 1) is white.
Mat4 rgbToXyz(const Primaries& p) {
  const Vec3d r{p.r.x, p.r.y, 1 - p.r.x - p.r.y}, g{p.g.x, p.g.y, 1 - p.g.x - p.g.y},
      b{p.b.x, p.b.y, 1 - p.b.x - p.b.y};
  const Vec3d weight = times(*inverse(columns(r, g, b)), toXyz(p.white));
  return columns(r * weight.x, g * weight.y, b * weight.z);
}

// Of a spectrum given by a function, at Y = 1.
template <class F>
Rgb normalised(const F& valueAt) {
  Vec3d xyz;
  for (int nanometres = 360; nanometres <= 830; ++nanometres)
    xyz += cie1931(nanometres) * valueAt(static_cast<double>(nanometres));
  return xyz.y > 0 ? clamped(xyzToRgb(xyz / xyz.y)) : Rgb(0.f);
}

double interpolate(const Spectrum& s, double wavelength) {
  const auto& w = s.wavelengths;
  if (wavelength < w.front() || wavelength > w.back()) return 0;
  const auto upper = std::upper_bound(w.begin() + 1, w.end() - 1, wavelength);
  const auto i = static_cast<size_t>(upper - w.begin());
  const double t = w[i] > w[i - 1] ? (wavelength - w[i - 1]) / (w[i] - w[i - 1]) : 1;
  return s.values[i - 1] * (1 - t) + s.values[i] * t;
}

}  // namespace

std::optional<ColorSpace> ColorSpace::named(const std::string& name) {
  for (const Primaries& p : kSpaces) {
    if (name != p.name) continue;
    ColorSpace space;
    space.isSrgb_ = &p == &kSpaces[0];
    space.matrix_ = *inverse(rgbToXyz(kSpaces[0])) * rgbToXyz(p);
    return space;
  }
  return std::nullopt;
}

std::vector<std::string> ColorSpace::names() {
  std::vector<std::string> out;
  for (const Primaries& p : kSpaces) out.emplace_back(p.name);
  return out;
}

Rgb ColorSpace::toSrgb(Rgb c) const {
  if (isSrgb_) return c;
  return clamped(times(matrix_, Vec3d(c.x, c.y, c.z)));
}

Rgb lightColor(const Spectrum& spectrum) {
  return normalised([&](double w) { return interpolate(spectrum, w); });
}

Rgb blackbodyLightColor(double kelvin) {
  constexpr double kSecond = 1.438776877e7;  // hc / k in nm K (CODATA 2018)
  return normalised(
      [&](double w) { return 1 / (std::pow(w / 560, 5) * std::expm1(kSecond / (w * kelvin))); });
}

Rgb reflectanceColor(const Spectrum& spectrum) {
  const Spectrum white{{300, 900}, {1, 1}};
  const Rgb one = spectrumToRgb(white, SpectrumUse::unbounded);
  return min(spectrumToRgb(spectrum, SpectrumUse::unbounded) / one, Rgb(1.f));
}

std::optional<Rgb> namedIlluminant(const std::string& name) {
  for (const Illuminant& i : kIlluminants)
    if (name == i.name) return clamped(xyzToRgb(toXyz(i.white)));
  return std::nullopt;
}

std::optional<Rgb> namedMetal(const std::string& name) {
  for (const std::string metal : kMetals) {
    const bool isEta = name == "metal-" + metal + "-eta";
    if (!isEta && name != "metal-" + metal + "-k") continue;
    if (metal == "CuZn") return isEta ? kBrassEta : kBrassK;
    const std::optional<ConductorConstants> constants = namedConductor(metal);
    if (constants) return isEta ? constants->eta : constants->k;
  }
  return std::nullopt;
}

std::optional<float> namedGlass(const std::string& name) {
  for (const Glass& g : kGlasses)
    if (name == g.name) return g.index;
  return std::nullopt;
}

std::vector<std::string> namedSpectra() {
  std::vector<std::string> out;
  for (const Illuminant& i : kIlluminants) out.emplace_back(i.name);
  for (const Glass& g : kGlasses) out.emplace_back(g.name);
  for (const std::string metal : kMetals)
    for (const char* part : {"-eta", "-k"}) out.push_back("metal-" + metal + part);
  return out;
}

}  // namespace lobelia::io::pbrt
