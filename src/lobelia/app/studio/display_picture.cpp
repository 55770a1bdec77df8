#include "lobelia/app/studio/display_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "lobelia/film/color_map.h"

namespace lobelia::app {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// The pixel of a film nearest to a place of the screen.
struct Lookup {
  const Film& film;
  int width, height;
  size_t operator()(int x, int y) const {
    const auto along = [](int at, int of, int to) {
      return std::min(static_cast<int>((int64_t{2} * at + 1) * to / (int64_t{2} * of)), to - 1);
    };
    return static_cast<size_t>(along(y, height, film.height)) * static_cast<size_t>(film.width) +
           static_cast<size_t>(along(x, width, film.width));
  }
};

float layerValue(const Film& film, const char* layer, size_t pixel) {
  const auto found = film.layers.find(layer);
  return found != film.layers.end() ? found->second.values[pixel] : kNothing;
}

// What a false colour stands for at a pixel of a picture. NaN: not known.
float valueOf(const Picture& picture, Shown shown, size_t pixel) {
  const float y = luminance(picture.film.rgb(pixel));
  switch (shown) {
    case Shown::picture:
    case Shown::luminance:
      return y;
    case Shown::illuminance:
      return picture.white ? kPi * y : kNothing;
    case Shown::cost:
      return layerValue(picture.film, "cost", pixel);
    case Shown::samples:
      return static_cast<float>(picture.samples);
    case Shown::error:
      return layerValue(picture.film, "error", pixel) / std::max(y, 1e-20f);
  }
  return kNothing;
}

class ValueMap {
 public:
  ValueMap(const DisplaySettings& settings, std::vector<float> values)
      : settings_(settings), values_(std::move(values)) {
    if (settings.fixedRange) {
      least_ = settings.least, most_ = settings.most;
    } else {
      measure();
    }
  }
  float least() const { return least_; }
  float most() const { return most_; }
  std::array<uint8_t, 3> color(size_t i) const {
    const float v = values_[i];
    if (!std::isfinite(v)) return {255, 0, 255};
    return cubehelix(settings_.logarithmic ? place(logOf(v), logOf(least_), logOf(most_))
                                           : place(v, least_, most_));
  }

 private:
  static float place(float v, float least, float most) {
    return most > least ? std::clamp((v - least) / (most - least), 0.f, 1.f) : 0.f;
  }
  float logOf(float v) const { return std::log(std::max(v, std::max(most_, 1e-30f) * 1e-6f)); }
  void measure() {
    std::vector<float> known;
    for (const float v : values_)
      if (std::isfinite(v) && (!settings_.logarithmic || v > 0)) known.push_back(v);
    if (known.empty()) return;
    const auto percentile = [&](double share) {
      const auto at = known.begin() +
                      static_cast<std::ptrdiff_t>(static_cast<double>(known.size() - 1) * share);
      std::nth_element(known.begin(), at, known.end());
      return *at;
    };
    least_ = percentile(0.01), most_ = percentile(0.99);
  }

  const DisplaySettings& settings_;
  const std::vector<float> values_;
  float least_ = 0, most_ = 0;
};

Rgb toned(Rgb value, const DisplaySettings& settings) {
  const float scale = settings.curve.scale * std::exp2(settings.exposure);
  Rgb c = value * scale;
  const float y = luminance(c);
  if (y > 0) c *= (1 + y / sqr(settings.curve.white)) / (1 + y);
  return isFinite(c) ? c : Rgb(1, 0, 1);
}

}  // namespace

const std::vector<std::string>& shownNames() {
  static const std::vector<std::string> names{"off",  "luminance", "illuminance",
                                              "cost", "samples",   "error"};
  return names;
}

Displayed displayPicture(const Picture& picture, const Picture* truth,
                         const DisplaySettings& settings) {
  Displayed out;
  out.width = settings.width > 0 ? settings.width : picture.film.width;
  out.height = settings.height > 0 ? settings.height : picture.film.height;
  const size_t width = static_cast<size_t>(out.width), height = static_cast<size_t>(out.height);
  out.pixels.assign(4 * width * height, 255);
  const bool split = truth != nullptr && settings.split >= 0;
  const int line =
      split ? static_cast<int>(std::clamp(settings.split, 0.f, 1.f) * static_cast<float>(out.width))
            : out.width;
  const Lookup own{picture.film, out.width, out.height};
  const Lookup other{truth != nullptr ? truth->film : picture.film, out.width, out.height};
  const auto put = [&](int x, int y, std::array<uint8_t, 3> c) {
    std::copy(c.begin(), c.end(),
              out.pixels.begin() + static_cast<std::ptrdiff_t>(4 * (static_cast<size_t>(y) * width +
                                                                    static_cast<size_t>(x))));
  };
  const auto each = [&](const auto& f) {
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x) f(x, y);
  };

  if (settings.shown == Shown::picture) {
    each([&](int x, int y) {
      const bool left = x < line;
      const Rgb value = left ? picture.film.rgb(own(x, y)) : truth->film.rgb(other(x, y));
      const Rgb c = toned(value, settings);
      std::array<uint8_t, 3> bytes;
      for (size_t k = 0; k < 3; ++k)
        bytes[k] = static_cast<uint8_t>(encodeSrgb(c[static_cast<int>(k)]) * 255 + 0.5f);
      put(x, y, bytes);
    });
  } else {
    const bool against = settings.shown == Shown::error && truth != nullptr;
    const double mean = against ? meanLuminance(truth->film) : 0;
    std::vector<float> values;
    values.reserve(width * height);
    each([&](int x, int y) {
      if (against) {
        const float t = luminance(truth->film.rgb(other(x, y)));
        const float v = luminance(picture.film.rgb(own(x, y)));
        values.push_back(std::abs(v - t) / (t + 0.01f * static_cast<float>(mean) + 1e-20f));
      } else {
        values.push_back(x < line ? valueOf(picture, settings.shown, own(x, y))
                                  : valueOf(*truth, settings.shown, other(x, y)));
      }
    });
    const ValueMap map(settings, std::move(values));
    each([&](int x, int y) {
      put(x, y, map.color(static_cast<size_t>(y) * width + static_cast<size_t>(x)));
    });
    out.least = map.least(), out.most = map.most();
  }
  if (split && line < out.width)
    for (int y = 0; y < out.height; ++y) put(line, y, {255, 255, 255});
  return out;
}

std::string whyNotShown(const Picture& picture, const Picture* truth, Shown shown) {
  if (shown == Shown::illuminance && !picture.white)
    return "the picture is not of white surfaces, which illuminance is measured on; choose this "
           "colour "
           "before the picture is drawn";
  if (shown == Shown::cost && picture.method == "transfer")
    return "transfer does not count what each pixel costs; choose another method or another colour";
  if (shown == Shown::cost && !picture.film.layers.contains("cost"))
    return "the picture has not counted its cost; choose this colour before it is drawn";
  if (shown == Shown::error && truth != nullptr && !picture.part.empty())
    return whyNoTruth(picture.part);
  if (shown == Shown::error && truth == nullptr && !picture.film.layers.contains("error"))
    return "there is neither a truth of this picture nor a second pass to know the error from; let "
           "the truth be drawn after it";
  return "";
}

std::string whyNoTruth(const std::string& part) {
  if (part.empty()) return "";
  return fmt::format(
      "the picture has {} alone, but a truth has all light; let the picture have it, too: in a "
      "script `bounce all` before the frame, or leave --component out",
      part);
}

std::vector<uint8_t> legendColors(int count) {
  std::vector<uint8_t> pixels;
  for (int i = 0; i < count; ++i) {
    const auto c = cubehelix(count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0);
    pixels.insert(pixels.end(), {c[0], c[1], c[2], 255});
  }
  return pixels;
}

}  // namespace lobelia::app
