#include "lobelia/app/render_virtual_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia::app {
namespace {

// Receivers of a band are gathered at once: enough of them to keep all threads busy, few enough
// for memory.
constexpr int kBandPixels = 1 << 17;

// Lights on emitters themselves (--direct lights) and lights of bounces, gathered into different
// layers.
struct LightParts {
  VirtualLights direct, indirect;
};

template <class Light>
void splitByDepth(const std::vector<Light>& lights, const std::vector<uint32_t>& ends,
                  std::vector<Light>& direct, std::vector<uint32_t>& directEnds,
                  std::vector<Light>& indirect, std::vector<uint32_t>& indirectEnds) {
  const uint32_t n = ends.empty() ? 0 : ends.front();
  direct.assign(lights.begin(), lights.begin() + n);
  indirect.assign(lights.begin() + n, lights.end());
  directEnds.assign(ends.empty() ? 0 : 1, n);
  indirectEnds = ends;
  for (uint32_t& end : indirectEnds) end -= n;
}

LightParts splitLights(const VirtualLights& lights) {
  LightParts parts;
  parts.direct.omni = lights.omni;
  parts.direct.directional = lights.directional;
  splitByDepth(lights.diffuse, lights.diffuseDepthEnds, parts.direct.diffuse,
               parts.direct.diffuseDepthEnds, parts.indirect.diffuse,
               parts.indirect.diffuseDepthEnds);
  splitByDepth(lights.glossy, lights.glossyDepthEnds, parts.direct.glossy,
               parts.direct.glossyDepthEnds, parts.indirect.glossy, parts.indirect.glossyDepthEnds);
  return parts;
}

// Default clamp of `vpl`: the geometry term of a light nearer than a twentieth of the scene's
// radius, the customary cure of its spikes.
float clampValue(const RenderOptions& options, float sceneRadius) {
  if (options.clamp == "off") return 0;
  if (options.clamp.empty()) {
    return options.lights == "vpl" ? kInvPi / sqr(0.05f * std::max(sceneRadius, 1e-6f)) : 0;
  }
  float value = 0;
  const char* end = options.clamp.data() + options.clamp.size();
  const auto [next, error] = std::from_chars(options.clamp.data(), end, value);
  if (error != std::errc() || next != end || !(value > 0) || !std::isfinite(value)) {
    throw UsageError(
        fmt::format("--clamp '{}' is neither a positive number nor 'off'", options.clamp));
  }
  return value;
}

VirtualLights obtainLights(const Tracer& tracer, const EmitterSampler& emitters, int maxDepth,
                           int set, const RenderOptions& options, Context& context) {
  LightSettings settings;
  settings.count = options.lightCount;
  settings.set = static_cast<uint32_t>(set);
  settings.maxDepth = maxDepth;
  settings.specularLimit = options.specularLimit;
  settings.glossy = options.lights != "vpl";
  settings.directAsLights = options.direct == "lights";
  settings.environmentLights = options.environmentLights;
  if (!options.loadLights.empty()) {
    const StageTimer timer(context, "lights");  // as makeLights() books its own seconds
    VirtualLights lights = loadLights(options.loadLights, hash(tracer.scene()));
    if (lights.model != options.lights) {
      throw InputError({options.loadLights, 0, 0},
                       fmt::format("holds lights of model '{}'; render with --lights {}",
                                   lights.model, lights.model));
    }
    requireFit(options.loadLights, lights, settings, tracer.scene());
    return lights;
  }
  VirtualLights lights = makeLights(tracer, emitters, settings, context);
  lights.model = options.lights;
  // Lights of a pass that was stopped lack a part of their power: of no use later.
  if (!options.saveLights.empty() && !context.cancelled()) {
    lights.sceneHash = hash(tracer.scene());
    saveLights(options.saveLights, lights);
  }
  return lights;
}

// Rows of every layer of a band, to take back what a cancelled band has added.
class BandBackup {
 public:
  BandBackup(Film& film, int y0, int y1) : film_(film), y0_(y0), y1_(y1) {
    for (const auto& [name, layer] : film.layers) {
      const auto [begin, end] = range(layer);
      rows_.emplace_back(layer.values.begin() + begin, layer.values.begin() + end);
    }
  }
  void restore() {
    size_t i = 0;
    for (auto& [name, layer] : film_.layers) {
      std::copy(rows_[i].begin(), rows_[i].end(), layer.values.begin() + range(layer).first);
      ++i;
    }
  }

 private:
  std::pair<ptrdiff_t, ptrdiff_t> range(const Layer& layer) const {
    const ptrdiff_t row = static_cast<ptrdiff_t>(film_.width) * layer.channels;
    return {y0_ * row, y1_ * row};
  }
  Film& film_;
  int y0_, y1_;
  std::vector<std::vector<float>> rows_;
};

void addToLayer(Film& film, const char* name, size_t pixel, Rgb value) {
  float* p = &film.layers.at(name).values[pixel * 3];
  p[0] += value.x, p[1] += value.y, p[2] += value.z;
}

void countReceivers(const Receivers& receivers, VirtualLightReport& report) {
  report.receiverPoints += receivers.points.size();
  for (const Lobe& lobe : receivers.lobes) {
    const bool diffuse = isDiffuse(lobe.type) || lobe.type == LobeType::diffuseTransmission;
    ++(diffuse ? report.diffuseReceivers : report.glossyReceivers);
  }
}

// Samples that every row got, when not all: rows are brought to the mean of what they have.
void finishPartial(Film& film, const std::vector<int>& rowSamples, int sampleCount) {
  if (std::all_of(rowSamples.begin(), rowSamples.end(), [&](int n) { return n == sampleCount; }))
    return;
  if (film.alpha.empty()) film.alpha.assign(film.pixelCount(), 1.f);
  const size_t width = static_cast<size_t>(film.width);
  for (size_t y = 0; y < rowSamples.size(); ++y) {
    const int n = rowSamples[y];
    if (n == 0) std::fill_n(film.alpha.begin() + static_cast<ptrdiff_t>(y * width), width, 0.f);
    if (n == 0 || n == sampleCount) continue;
    for (auto& [name, layer] : film.layers) {
      const size_t row = width * static_cast<size_t>(layer.channels);
      for (size_t i = 0; i < row; ++i) {
        layer.values[y * row + i] *= static_cast<float>(sampleCount) / static_cast<float>(n);
      }
    }
  }
}

// Variance of the mean over the samples of a pixel, from the picture after each sample. Samples
// that gather the same lights share those lights' error, which does not show in it.
class VarianceMeter {
 public:
  explicit VarianceMeter(Film& film) : film_(film), used_(film.layers.contains("variance")) {
    if (!used_) return;
    previous_.assign(film.pixelCount() * 3, 0.f);
    squares_.assign(film.pixelCount() * 3, 0.);
  }
  void afterSample(int sampleCount) {
    if (!used_) return;
    const auto& d = film_.layers.at("direct").values;
    const auto& i = film_.layers.at("indirect").values;
    for (size_t k = 0; k < previous_.size(); ++k) {
      const double sample = static_cast<double>(d[k] + i[k] - previous_[k]) * sampleCount;
      squares_[k] += sample * sample;
      previous_[k] = d[k] + i[k];
    }
  }
  // rowSamples: how many samples every row got.
  void finish(const std::vector<int>& rowSamples, int sampleCount) {
    if (!used_) return;
    auto& out = film_.layers.at("variance").values;
    const size_t row = static_cast<size_t>(film_.width) * 3;
    for (size_t k = 0; k < out.size(); ++k) {
      const double n = rowSamples[k / row];
      if (n < 2) continue;
      const double mean = static_cast<double>(previous_[k]) * sampleCount / n;
      out[k] = static_cast<float>(std::max(squares_[k] / n - mean * mean, 0.) / (n - 1));
    }
  }

 private:
  Film& film_;
  bool used_;
  std::vector<float> previous_;
  std::vector<double> squares_;
};

}  // namespace

VirtualLightReport renderVirtualLights(const Tracer& tracer, const EmitterSampler& emitters,
                                       const Camera& camera, const PixelSet& pixels, int maxDepth,
                                       const RenderOptions& options, Film& film, Context& context) {
  const int64_t start = nanosecondsNow();
  GatherSettings gather;
  gather.clamp = clampValue(options, tracer.bounds().radius());
  gather.maxDepth = maxDepth;
  gather.direct = options.direct == "lights";
  VirtualLightReport report;
  report.lights = obtainLights(tracer, emitters, maxDepth, 0, options, context);
  LightParts parts = splitLights(report.lights);

  EyeSettings eye;
  eye.sampleCount = options.spp > 0 ? options.spp : 16;
  eye.maxDepth = maxDepth;
  eye.specularLimit = options.specularLimit;
  if (options.direct == "lights") eye.directSamples = 0;
  eye.hideEmitters = tracer.scene().hideEmitters;
  eye.pixels = pixels;

  const int bandRows = std::clamp(kBandPixels / std::max(film.width, 1) / 8 * 8, 8, 4096);
  const int bands = (film.height + bandRows - 1) / bandRows;
  std::vector<int> rowSamples(static_cast<size_t>(film.height), 0);
  VarianceMeter variance(film);
  const auto outOfTime = [&] {
    return options.timeLimit > 0 &&
           static_cast<double>(nanosecondsNow() - start) * 1e-9 > options.timeLimit;
  };
  const auto stop = [&] { return context.cancelled() || outOfTime(); };
  std::vector<Rgb> radiance;
  const auto gatherInto = [&](const Receivers& receivers, const VirtualLights& lights,
                              bool direct) {
    if (lights.size() == 0 || receivers.points.empty()) return;
    radiance.assign(receivers.points.size(), Rgb{});
    gatherAll(tracer, receivers, lights, gather, radiance, context);
    for (size_t i = 0; i < radiance.size(); ++i) {
      const ReceiverPoint& point = receivers.points[i];
      addToLayer(film, direct && point.primary ? "direct" : "indirect", point.pixel, radiance[i]);
    }
  };

  const bool oneSet = !options.saveLights.empty() || !options.loadLights.empty();
  const int passes = options.passes > 0 ? options.passes : oneSet ? 1 : eye.sampleCount;
  report.sets = std::min(passes, eye.sampleCount);
  int set = 0;
  for (eye.sample = 0; eye.sample < eye.sampleCount && !stop(); ++eye.sample) {
    const int wanted = static_cast<int>(int64_t{eye.sample} * report.sets / eye.sampleCount);
    if (wanted != set) {
      set = wanted;
      parts = splitLights(obtainLights(tracer, emitters, maxDepth, set, options, context));
    }
    for (int band = 0; band < bands && !stop(); ++band) {
      const int y0 = band * bandRows, y1 = std::min(y0 + bandRows, film.height);
      BandBackup backup(film, y0, y1);
      const Receivers receivers =
          traceReceivers(tracer, emitters, camera, eye, y0, y1, film, context);
      countReceivers(receivers, report);
      gatherInto(receivers, parts.direct, true);
      if (options.component != "direct") gatherInto(receivers, parts.indirect, false);
      if (context.cancelled()) {
        backup.restore();
        break;
      }
      for (int y = y0; y < y1; ++y) ++rowSamples[static_cast<size_t>(y)];
      context.progress("render",
                       (eye.sample + static_cast<double>(band + 1) / bands) / eye.sampleCount);
    }
    variance.afterSample(eye.sampleCount);
  }
  if (outOfTime() && !context.cancelled() &&
      std::find(rowSamples.begin(), rowSamples.end(), 0) != rowSamples.end()) {
    context.warning("--time-limit ended before every pixel had a sample; these have alpha 0");
  }
  finishPartial(film, rowSamples, eye.sampleCount);
  variance.finish(rowSamples, eye.sampleCount);
  return report;
}

}  // namespace lobelia::app
