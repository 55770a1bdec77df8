// Colours, spectra and numbers of Mitsuba scenes, each of which may be a texture instead.
#include "lobelia/film/film.h"
#include "lobelia/io/hex_digit.h"
#include "lobelia/io/mitsuba/reader.h"

namespace lobelia::io::mitsuba {
namespace {

// "#rrggbb" to [0,1], as encoded.
Rgb hexColor(const std::string& text, const Element& element) {
  Rgb out;
  bool valid = text.size() == 7;
  for (int c = 0; valid && c < 3; ++c) {
    const int high = hexDigit(text[static_cast<size_t>(1 + 2 * c)]);
    const int low = hexDigit(text[static_cast<size_t>(2 + 2 * c)]);
    valid = high >= 0 && low >= 0;
    out[c] = static_cast<float>(high * 16 + low) / 255.f;
  }
  if (!valid) throw InputError(element.where, "'" + text + "' is not a colour such as #4080ff");
  return out;
}

}  // namespace

Rgb Reader::rgb(const Element& element) const {
  const std::string& text = element.value("value");
  const bool encoded = element.tag == "srgb";
  Rgb out;
  if (const std::vector<std::string> words = tokens(text);
      words.size() == 1 && words[0][0] == '#') {
    out = hexColor(words[0], element);
  } else {
    const std::vector<double> v = parseNumbers(text, element);
    if (v.size() != 1 && v.size() != 3) {
      throw InputError(element.where, "<" + element.tag + "> needs one or three values, not " +
                                          std::to_string(v.size()));
    }
    for (int c = 0; c < 3; ++c) {
      out[c] = static_cast<float>(v[v.size() == 1 ? 0 : static_cast<size_t>(c)]);
    }
  }
  if (encoded) out = {decodeSrgb(out.x), decodeSrgb(out.y), decodeSrgb(out.z)};
  return out;
}

Rgb Reader::sampledSpectrum(const Spectrum& spectrum, SpectrumUse use, const Location& where) {
  checkSpectrum(spectrum, where);
  bool clamped = false;
  const Rgb out = spectrumToRgb(spectrum, use, &clamped);
  if (clamped) findings_.warn(where, "the spectrum's colour is outside of sRGB and was clamped");
  return out;
}

Rgb Reader::inlineSpectrum(const Element& element, SpectrumUse use) {
  if (element.has("filename") == element.has("value")) {
    throw InputError(element.where, "<spectrum> needs either a value or a filename");
  }
  if (element.has("filename")) {
    const std::string path = document_.resolve(element.value("filename"), element.where);
    return sampledSpectrum(readSpectrum(path, element.where), use, element.where);
  }
  const std::vector<std::string> words = tokens(element.value("value"));
  if (words.size() == 1 && words[0].find(':') == std::string::npos) {
    return Rgb(static_cast<float>(parseNumber(words[0], element)));
  }
  Spectrum spectrum;
  for (const std::string& word : words) {
    const size_t colon = word.find(':');
    if (colon == std::string::npos) {
      throw InputError(element.where, "'" + word + "' is not a pair wavelength:value");
    }
    spectrum.wavelengths.push_back(parseNumber(word.substr(0, colon), element));
    spectrum.values.push_back(parseNumber(word.substr(colon + 1), element));
  }
  return sampledSpectrum(spectrum, use, element.where);
}

// <spectrum type="..."> or <texture type="..."> of the spectrum plugins.
Rgb Reader::spectrumPlugin(const Element& element, SpectrumUse use) {
  Object object = open(element);
  const std::string& type = object.type();
  Rgb out;
  if (type == "uniform") {
    out = Rgb(object.number("value", 1.f));
    object.ignore({"wavelength_min", "wavelength_max"});
  } else if (type == "d65") {
    out = constantColor(object, "color", Rgb(1.f), use) * object.number("scale", 1.f);
  } else if (type == "srgb" || type == "srgb_d65" || type == "rgb") {
    out = constantColor(object, object.has("color") ? "color" : "value", Rgb(1.f), use) *
          object.number("scale", 1.f);
    object.ignore({"unbounded"});
  } else if (type == "blackbody") {
    const std::optional<double> kelvin = object.number("temperature");
    if (!kelvin || *kelvin <= 0) {
      throw InputError(object.where(), "the blackbody needs a temperature above 0 (kelvin)");
    }
    out = blackbodyToRgb(*kelvin) * object.number("scale", 1.f);
  } else if (type == "regular" || type == "irregular") {
    Spectrum s;
    s.values = parseNumbers(object.string("values").value_or(""), element);
    if (type == "irregular") {
      s.wavelengths = parseNumbers(object.string("wavelengths").value_or(""), element);
    } else {
      const double lo = object.number("wavelength_min", object.number("lambda_min", 360.f));
      const double hi = object.number("wavelength_max", object.number("lambda_max", 830.f));
      const size_t n = s.values.size();
      for (size_t i = 0; i < n; ++i) {
        s.wavelengths.push_back(lo + (hi - lo) * static_cast<double>(i) /
                                         static_cast<double>(std::max<size_t>(n - 1, 1)));
      }
    }
    if (s.wavelengths.size() != s.values.size()) {
      throw InputError(object.where(), "the spectrum has " + std::to_string(s.values.size()) +
                                           " values for " + std::to_string(s.wavelengths.size()) +
                                           " wavelengths");
    }
    out = sampledSpectrum(s, use, object.where());
  } else {
    unknownType(object,
                {"uniform", "d65", "srgb", "srgb_d65", "rgb", "blackbody", "regular", "irregular"});
  }
  object.finish();
  return out;
}

ColorParam Reader::color(const Element& e, SpectrumUse use) {
  static const std::set<std::string> kSpectra{"uniform", "d65",       "srgb",    "srgb_d65",
                                              "rgb",     "blackbody", "regular", "irregular"};
  Rgb value;
  if (e.tag == "texture" && !kSpectra.contains(e.value("type"))) return texture(e);
  if (e.tag == "float" || e.tag == "integer") {
    value = Rgb(static_cast<float>(parseNumber(e.value("value"), e)));
  } else if (e.tag == "rgb" || e.tag == "srgb") {
    value = rgb(e);
  } else if (e.tag == "texture" || (e.tag == "spectrum" && e.has("type"))) {
    value = spectrumPlugin(e, use);
  } else if (e.tag == "spectrum") {
    value = inlineSpectrum(e, use);
  } else if (e.tag == "blackbody") {
    std::string kelvin = e.value("temperature");
    if (!kelvin.empty() && (kelvin.back() == 'K' || kelvin.back() == 'k')) kelvin.pop_back();
    const double t = parseNumber(kelvin, e);
    if (t <= 0) throw InputError(e.where, "the temperature must be above 0 (kelvin)");
    value = blackbodyToRgb(t);
    if (e.has("scale")) value *= static_cast<float>(parseNumber(e.value("scale"), e));
  } else {
    wrongKind(e, "colour: <rgb>, <spectrum> or <texture>");
  }
  if (minComponent(value) < 0) {
    throw InputError(e.where, "'" + e.name + "' has a negative component");
  }
  return value;
}

ColorParam Reader::color(Object& object, const std::string& name, Rgb otherwise, SpectrumUse use) {
  const Element* e = object.property(name);
  return e ? color(*e, use) : ColorParam(otherwise);
}

Rgb Reader::constantColor(Object& object, const std::string& name, Rgb otherwise, SpectrumUse use) {
  const Element* e = object.property(name);
  if (!e) return otherwise;
  const ColorParam param = color(*e, use);
  if (param.texture.valid()) {
    throw InputError(e->where, "'" + name + "' cannot be a texture here; give a constant");
  }
  return param.value;
}

FloatParam Reader::scalar(Object& object, const std::string& name, float otherwise) {
  const Element* e = object.property(name);
  if (!e) return otherwise;
  if (e->tag == "float" || e->tag == "integer") {
    return static_cast<float>(parseNumber(e->value("value"), *e));
  }
  const ColorParam param = color(*e, SpectrumUse::unbounded);
  if (param.texture.valid()) return e->legacy ? param.texture : scalarTexture(param.texture);
  const Rgb v = param.value;
  return v.x == v.y && v.y == v.z ? v.x : luminance(v);
}

}  // namespace lobelia::io::mitsuba
