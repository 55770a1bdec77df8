// Colour parameters: rgb, blackbody and spectra inline, by file and by name.
#include <fmt/format.h>

#include <filesystem>

#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

[[noreturn]] void wrongCount(const Parameter& p, size_t expected) {
  throw InputError(p.where, fmt::format("'{}' has {} values; a {} takes {}", p.name,
                                        p.numbers.size() + p.strings.size(), p.type, expected));
}

}  // namespace

Rgb Reader::namedSpectrum(const Parameter& p, SpectrumUse use) {
  if (p.strings.size() != 1 || !p.numbers.empty()) wrongCount(p, 1);
  const std::string& name = p.strings[0];
  if (const std::optional<Rgb> illuminant = namedIlluminant(name)) {
    if (use != SpectrumUse::emission)
      findings_.warn(p.where, fmt::format("'{}' is the spectrum of a light; here it stands for its "
                                          "colour",
                                          name));
    return use == SpectrumUse::reflectance ? min(*illuminant, Rgb(1.f)) : *illuminant;
  }
  if (const std::optional<Rgb> metal = namedMetal(name)) return *metal;
  if (const std::optional<float> glass = namedGlass(name)) return Rgb(*glass);
  std::error_code error;
  const bool looksLikeFile =
      std::filesystem::exists(std::filesystem::path(folder_) / name, error) ||
      name.find_first_of("./") != name.npos;
  if (!looksLikeFile) throw InputError(p.where, unknownName("spectrum", name, namedSpectra()));
  const Spectrum spectrum = readSpectrum(resolve(name, "spectrum", p.where), p.where);
  if (use == SpectrumUse::emission) return pbrt::lightColor(spectrum);
  if (use == SpectrumUse::reflectance) return reflectanceColor(spectrum);
  return spectrumToRgb(spectrum, use);
}

Rgb Reader::constantColor(const Parameter& p, SpectrumUse use) {
  if (p.type == "rgb" || p.type == "color") {
    if (p.numbers.size() != 3) wrongCount(p, 3);
    Rgb value;
    for (int i = 0; i < 3; ++i) {
      value[i] = static_cast<float>(p.numbers[static_cast<size_t>(i)]);
      if (!(value[i] >= 0) || !std::isfinite(value[i]))
        throw InputError(p.where, fmt::format("'{}' has the value {}; colours are 0 or more",
                                              p.name, p.numbers[static_cast<size_t>(i)]));
    }
    return state_.colorSpace.toSrgb(value);
  }
  if (p.type == "blackbody") {
    if (p.numbers.size() != 1) wrongCount(p, 1);
    if (!(p.numbers[0] >= 100) || p.numbers[0] > 1e8)
      throw InputError(
          p.where, fmt::format("a black body of {} kelvin; 100 to 1e8 are possible", p.numbers[0]));
    const Rgb value = blackbodyLightColor(p.numbers[0]);
    return use == SpectrumUse::reflectance ? min(value, Rgb(1.f)) : value;
  }
  if (p.type != "spectrum") {  // a number
    if (p.numbers.size() != 1) wrongCount(p, 1);
    return Rgb(static_cast<float>(p.numbers[0]));
  }
  if (!p.strings.empty()) return namedSpectrum(p, use);
  Spectrum spectrum;
  if (p.numbers.size() % 2 != 0)
    throw InputError(p.where, fmt::format("the spectrum '{}' has {} numbers; it takes pairs of "
                                          "wavelength and value",
                                          p.name, p.numbers.size()));
  for (size_t i = 0; i < p.numbers.size(); i += 2) {
    spectrum.wavelengths.push_back(p.numbers[i]);
    spectrum.values.push_back(p.numbers[i + 1]);
  }
  checkSpectrum(spectrum, p.where);
  if (use == SpectrumUse::emission) return pbrt::lightColor(spectrum);
  if (use == SpectrumUse::reflectance) return reflectanceColor(spectrum);
  return spectrumToRgb(spectrum, use);
}

std::optional<Rgb> Reader::color(Parameters& in, const std::string& name, SpectrumUse use) {
  const Parameter* p = in.find(name, {"rgb", "spectrum", "blackbody", "color", "float"});
  if (!p) return std::nullopt;
  return constantColor(*p, use);
}

}  // namespace lobelia::io::pbrt
