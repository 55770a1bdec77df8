// Reinhard, Stark, Shirley and Ferwerda 2002, "Photographic Tone Reproduction for Digital Images",
// section 2 (equations 1-4), applied to luminance so that hues keep. The white point is the
// 99.9th percentile of scaled luminance instead of the maximum, so that one bright pixel does not
// darken the picture's whites.
#include <algorithm>
#include <cstddef>

#include "lobelia/film/film.h"

namespace lobelia {

float encodeSrgb(float v) {
  if (!(v > 0)) return 0;
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(std::min(v, 1.f), 1 / 2.4f) - 0.055f;
}

float decodeSrgb(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

namespace {

bool present(const Film& film, size_t i) { return film.alpha.empty() || film.alpha[i] > 0; }

// Log-average luminance (equation 1) over pixels that are lit at all.
double logAverage(const Film& film, const std::string& layer) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const float y = luminance(film.rgb(i, layer));
    if (!present(film, i) || !std::isfinite(y) || y <= 1e-6f) continue;
    sum += std::log(y);
    ++count;
  }
  return count > 0 ? std::exp(sum / static_cast<double>(count)) : 1;
}

float whitePoint(const Film& film, const std::string& layer, float scale) {
  std::vector<float> values;
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const float y = luminance(film.rgb(i, layer)) * scale;
    if (present(film, i) && std::isfinite(y)) values.push_back(y);
  }
  if (values.empty()) return 1;
  const auto nth =
      values.begin() + static_cast<ptrdiff_t>(static_cast<double>(values.size() - 1) * 0.999);
  std::nth_element(values.begin(), nth, values.end());
  return std::max(*nth, 1.f);
}

}  // namespace

ToneCurve measureToneCurve(const Film& film, const ToneMapping& settings,
                           const std::string& layer) {
  const double gain = std::exp2(settings.exposure) * settings.key;
  ToneCurve curve;
  curve.scale = static_cast<float>(gain / logAverage(film, layer));
  curve.white = whitePoint(film, layer, curve.scale);
  return curve;
}

std::vector<uint8_t> toneMap(const Film& film, const ToneCurve& curve, const std::string& layer) {
  std::vector<uint8_t> out(film.pixelCount() * 3);
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    Rgb c = film.rgb(i, layer) * curve.scale;
    const float y = luminance(c);
    if (y > 0) c *= (1 + y / sqr(curve.white)) / (1 + y);
    if (!isFinite(c)) c = {1, 0, 1};
    for (int k = 0; k < 3; ++k) {
      out[i * 3 + static_cast<size_t>(k)] = static_cast<uint8_t>(encodeSrgb(c[k]) * 255 + 0.5f);
    }
  }
  return out;
}

}  // namespace lobelia
