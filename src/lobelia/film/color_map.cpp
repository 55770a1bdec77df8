#include "lobelia/film/color_map.h"

#include <algorithm>
#include <cmath>

namespace lobelia {

std::array<uint8_t, 3> cubehelix(float x) {
  constexpr float kStart = 0.5f, kRotations = -1.5f, kHue = 1;
  const float l = std::clamp(x, 0.f, 1.f);
  const float angle = kTwoPi * (kStart / 3 + 1 + kRotations * l);
  const float a = kHue * l * (1 - l) / 2;
  const float c = std::cos(angle), s = std::sin(angle);
  const float rgb[3] = {l + a * (-0.14861f * c + 1.78277f * s),
                        l + a * (-0.29227f * c - 0.90649f * s), l + a * 1.97294f * c};
  std::array<uint8_t, 3> out;
  for (size_t i = 0; i < 3; ++i)
    out[i] = static_cast<uint8_t>(std::clamp(rgb[i], 0.f, 1.f) * 255 + 0.5f);
  return out;
}

std::array<uint8_t, 3> blueWhiteRed(float x) {
  const float t = std::clamp(x, -1.f, 1.f), rest = 1 - std::abs(t);
  const auto byte = [](float v) { return static_cast<uint8_t>(v * 255 + 0.5f); };
  const auto blend = [&](float end) { return byte(rest + (1 - rest) * end); };
  if (t > 0) return {blend(0.7f), blend(0.f), blend(0.1f)};
  return {blend(0.1f), blend(0.2f), blend(0.7f)};
}

double meanLuminance(const Film& film) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const float value = luminance(film.rgb(i));
    if (!std::isfinite(value)) continue;
    sum += static_cast<double>(value);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

namespace {

template <class Color>
std::vector<uint8_t> differenceColors(const Film& film, const Film& reference, float scale,
                                      std::array<uint8_t, 3> notFinite, const Color& color) {
  std::vector<uint8_t> pixels;
  pixels.reserve(3 * film.pixelCount());
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const float value = luminance(film.rgb(i) - reference.rgb(i)) / scale;
    const std::array<uint8_t, 3> c = std::isfinite(value) ? color(value) : notFinite;
    pixels.insert(pixels.end(), c.begin(), c.end());
  }
  return pixels;
}

}  // namespace

std::vector<uint8_t> signedDifference(const Film& film, const Film& reference, float scale) {
  return differenceColors(film, reference, scale, {0, 0, 0}, blueWhiteRed);
}

std::vector<uint8_t> absoluteDifference(const Film& film, const Film& reference, float scale) {
  return differenceColors(film, reference, scale, {255, 0, 255},
                          [](float x) { return cubehelix(std::abs(x)); });
}

FalseColors falseColors(const Film& film, const std::string& layer) {
  const size_t count = film.pixelCount();
  std::vector<float> values(count);
  FalseColors out;
  bool any = false;
  for (size_t i = 0; i < count; ++i) {
    values[i] =
        film.layers.at(layer).channels >= 3 ? luminance(film.rgb(i, layer)) : film.rgb(i, layer).x;
    if (!std::isfinite(values[i])) continue;
    out.least = any ? std::min(out.least, values[i]) : values[i];
    out.most = any ? std::max(out.most, values[i]) : values[i];
    any = true;
  }
  const float range = out.most - out.least;
  out.pixels.reserve(3 * count);
  for (const float v : values) {
    const std::array<uint8_t, 3> c = !std::isfinite(v)
                                         ? std::array<uint8_t, 3>{255, 0, 255}
                                         : cubehelix(range > 0 ? (v - out.least) / range : 0);
    out.pixels.insert(out.pixels.end(), c.begin(), c.end());
  }
  return out;
}

}  // namespace lobelia
