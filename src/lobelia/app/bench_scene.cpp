#include "lobelia/app/bench_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "lobelia/app/band_plan.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/app/light_sets.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/base/random.h"

namespace lobelia::app {
namespace {

RenderOptions renderOptions(const BenchOptions& options, const BenchScene::Defaults& defaults) {
  RenderOptions out;
  out.nearLights = 0;  // the light of the lights alone is what studies compare
  out.scene = options.scene;
  if (out.scene.scene.empty()) out.scene.scene = defaults.scene;
  out.size = options.size;
  out.camera = options.camera;
  out.pixels = options.pixels > 0 ? options.pixels : defaults.pixels;
  out.maxDepth = options.maxDepth;
  out.seed = options.seed;
  out.component = defaults.component;
  out.passes = 1;  // the studies draw their sets themselves
  return out;
}

Camera scaledCamera(Camera camera, int width) {
  camera.height = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(width) * camera.height / camera.width)));
  camera.width = width;
  camera.cropX0 = camera.cropY0 = 0, camera.cropX1 = camera.width, camera.cropY1 = camera.height;
  return camera;
}

Scene preparedScene(const SceneOptions& options, const BenchScene::Defaults& defaults,
                    Context& context) {
  Scene scene = loadScene(options, context);
  if (defaults.prepare) defaults.prepare(scene);
  return scene;
}

}  // namespace

Estimate estimate(const std::vector<double>& independent) {
  const double n = static_cast<double>(independent.size());
  double sum = 0, squares = 0;
  for (const double v : independent) sum += v;
  for (const double v : independent) squares += (v - sum / n) * (v - sum / n);
  return {sum / n, std::sqrt(squares / (n * (n - 1)))};
}

Estimate ratio(Estimate a, Estimate b) {
  const double r = a.mean / b.mean;
  return {r, std::abs(r) * std::hypot(a.error / a.mean, b.error / b.mean)};
}

std::vector<double> clampValues(float radius, int stepsAbove) {
  const double middle = std::round(-2 * std::log10(static_cast<double>(std::max(radius, 1e-6f))));
  std::vector<double> values;
  for (int i = -4; i <= stepsAbove; ++i) values.push_back(std::pow(10, middle + 0.5 * i));
  values.push_back(std::numeric_limits<double>::infinity());
  return values;
}

std::string clampText(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "off";
}

BenchScene::BenchScene(const BenchOptions& options, const Defaults& defaults, Context& context)
    : options_(renderOptions(options, defaults)),
      context_(context),
      scene_(preparedScene(options_.scene, defaults, context)),
      camera_(chooseCamera(scene_, options_)),
      maxDepth_(options_.maxDepth > 0 ? options_.maxDepth : scene_.maxDepth),
      tracer_(scene_, context),
      emitters_(scene_, tracer_.bounds()) {
  name_ = options_.scene.scene;
  if (options_.size.empty() && defaults.width > 0) camera_ = scaledCamera(camera_, defaults.width);
  pixels_ = choosePixels(camera_, options_);
}

size_t BenchScene::pixelCount() const {
  return pixels_.pixels.empty() ? pictureCount() : pixels_.pixels.size();
}

size_t BenchScene::pictureCount() const {
  return static_cast<size_t>(camera_.cropX1 - camera_.cropX0) *
         static_cast<size_t>(camera_.cropY1 - camera_.cropY0);
}

Film BenchScene::render(const RenderOptions& options, uint64_t seed, Extent extent,
                        const Method& method) {
  const PixelSet pixels = extent == Extent::pixels ? pixels_ : PixelSet{};
  Film film = makeFilm(camera_, options);
  context_.seed = hashCombine(options_.seed, seed);
  method(pixels, film);
  if (!pixels.pixels.empty()) {
    film.alpha.assign(film.pixelCount(), 0.f);
    for (const uint32_t pixel : pixels.pixels) film.alpha[pixel] = 1;
  }
  composePicture(film, options);
  return film;
}

Film BenchScene::pathTraced(const RenderOptions& options, int spp, uint64_t seed, Extent extent) {
  PathSettings settings;
  settings.spp = spp;
  settings.maxDepth = maxDepth_;
  settings.specularLimit = options.specularLimit;
  settings.component = componentOf(options);
  settings.hideEmitters = scene_.hideEmitters;
  return render(options, seed, extent, [&](const PixelSet& pixels, Film& film) {
    settings.pixels = pixels;
    renderPath(tracer_, emitters_, camera_, settings, film, context_);
  });
}

Film BenchScene::pathTraced(int spp, uint64_t seed, Extent extent) {
  return pathTraced(options_, spp, seed, extent);
}

Film BenchScene::directLight(int spp, uint64_t seed, Extent extent) {
  RenderOptions options = options_;
  options.component = "direct";
  return pathTraced(options, spp, seed, extent);
}

Film BenchScene::virtualLights(const std::string& model, const std::string& clamp,
                               uint64_t lightCount, int spp, uint64_t seed) {
  const auto change = [&](RenderOptions& options) {
    options.lights = model;
    options.clamp = clamp;
    options.lightCount = lightCount;
    options.spp = spp;
  };
  return virtualLights(change, seed);
}

Film BenchScene::virtualLights(const Change& change, uint64_t seed, Extent extent) {
  RenderOptions options = options_;
  change(options);
  return render(options, seed, extent, [&](const PixelSet& pixels, Film& film) {
    renderVirtualLights(tracer_, emitters_, camera_, pixels, maxDepth_, options, film, context_);
  });
}

VirtualLights BenchScene::lights(const Change& change, uint64_t seed) {
  RenderOptions options = options_;
  change(options);
  context_.seed = hashCombine(options_.seed, seed);
  return obtainLights(tracer_, emitters_, maxDepth_, 0, options, context_);
}

Film BenchScene::withLights(VirtualLights lights, const Change& change, uint64_t seed,
                            Extent extent) {
  RenderOptions options = options_;
  change(options);
  std::optional<VirtualLights> set = std::move(lights);
  return render(options, seed, extent, [&](const PixelSet& pixels, Film& film) {
    renderVirtualLights(tracer_, emitters_, camera_, pixels, maxDepth_, options, film, context_,
                        nullptr, nullptr, &set);
  });
}

BenchScene::Gathered BenchScene::gathered(std::optional<VirtualLights>* lights,
                                          const Change& change, uint64_t seed, Extent extent) {
  RenderOptions options = options_;
  change(options);
  Gathered result;
  result.film = render(options, seed, extent, [&](const PixelSet& pixels, Film& film) {
    addLightLayers(emitters_.groups(), options, film);
    result.report = renderVirtualLights(tracer_, emitters_, camera_, pixels, maxDepth_, options,
                                        film, context_, nullptr, nullptr, lights);
  });
  return result;
}

std::pair<Receivers, GatherSettings> BenchScene::receivers(const Change& change, uint64_t seed) {
  RenderOptions options = options_;
  change(options);
  Film film = makeFilm(camera_, options);
  context_.seed = hashCombine(options_.seed, seed);
  const BandPlan plan = planBands(tracer_, {}, maxDepth_, 1, options, film);
  return {traceReceivers(tracer_, emitters_, camera_, plan.eye, 0, film.height, film, context_),
          plan.gather};
}

double BenchScene::mean(const Film& film) const {
  double sum = 0;
  for (const float v : film.layers.at("").values) sum += static_cast<double>(v);
  return sum / (3 * static_cast<double>(pixelCount()));
}

Reference pathReference(BenchScene& scene, int spp, uint64_t seed, Context& context) {
  constexpr int kRuns = 4;  // of each half
  Reference reference;
  std::vector<double> means;
  for (int i = 0; i < 2 * kRuns && !context.cancelled(); ++i) {
    context.progress(std::string(kBenchStage) + scene.name() + ", path tracer", i / (2.0 * kRuns));
    const Film film = scene.pathTraced(std::max(1, spp / (2 * kRuns)),
                                       hashCombine(seed, static_cast<uint64_t>(i)));
    means.push_back(scene.mean(film));
    Film& half = i < kRuns ? reference.first : reference.second;
    if (i % kRuns == 0) {
      half = film;
      for (float& v : half.layers.at("").values) v /= kRuns;
    } else {
      const std::vector<float>& values = film.layers.at("").values;
      std::vector<float>& sum = half.layers.at("").values;
      for (size_t k = 0; k < sum.size(); ++k) sum[k] += values[k] / kRuns;
    }
  }
  reference.mean = estimate(means);
  return reference;
}

}  // namespace lobelia::app
