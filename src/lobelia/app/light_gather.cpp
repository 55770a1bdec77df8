#include "lobelia/app/light_gather.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lobelia/app/receiver_sample.h"
#include "lobelia/base/error.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/gather_cuts.h"
#include "lobelia/gather/light_slices.h"
#include "lobelia/gather/lightcuts.h"
#include "lobelia/gather/stochastic_lightcuts.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kStream = 0x73676c63;  // of everything random here

using Prepared = std::unique_ptr<gather::PreparedGather>;

gather::CutGatherSettings cutSettings(const RenderOptions& options, const BandPlan& plan,
                                      int width) {
  gather::CutGatherSettings settings;
  settings.gather = plan.gather;
  settings.cut.nodes = cutSizeOf(options);
  settings.shared = cutModeOf(options) == "shared";
  settings.width = width;
  return settings;
}

gather::SliceSettings sliceSettings(const RenderOptions& options, const BandPlan& plan) {
  gather::SliceSettings settings;
  settings.gather = plan.gather;
  settings.slices = slicesOf(options);
  settings.columns = sliceColumnsOf(options);
  settings.memory = options.memory;
  return settings;
}

gather::LightcutsSettings lightcutsSettings(const RenderOptions& options, const BandPlan& plan) {
  gather::LightcutsSettings settings;
  settings.gather = plan.gather;
  settings.threshold = thresholdOf(options);
  settings.cutSize = cutSizeOf(options);
  return settings;
}

gather::StochasticSettings stochasticSettings(const RenderOptions& options, const BandPlan& plan) {
  gather::StochasticSettings settings;
  settings.gather = plan.gather;
  settings.threshold = thresholdOf(options);
  settings.cutSize = cutSizeOf(options);
  return settings;
}

// Pixels of which slices are made.
size_t slicedPixels(const RenderOptions& options) {
  constexpr size_t kPixelsPerSlice = 64;
  return kPixelsPerSlice * slicesOf(options);
}

}  // namespace

std::string cutModeOf(const RenderOptions& options) {
  return options.cutMode.empty() ? "shared" : options.cutMode;
}
size_t cutSizeOf(const RenderOptions& options) {
  if (options.cutSize > 0) return options.cutSize;
  if (options.gather == "lightcuts") return gather::LightcutsSettings().cutSize;
  if (options.gather == "stochastic") return gather::StochasticSettings().cutSize;
  return gather::CutSettings().nodes;
}
float thresholdOf(const RenderOptions& options) {
  if (options.threshold >= 0) return options.threshold;
  return options.gather == "stochastic" ? gather::StochasticSettings().threshold
                                        : gather::LightcutsSettings().threshold;
}

void requireGather(const RenderOptions& options) {
  if (options.gather != "all" && (options.lights == "path" || options.lights == "light")) {
    throw UsageError(fmt::format(
        "--gather {} gathers virtual lights and --lights {} has none; use vpl, glossy or vsl",
        options.gather, options.lights));
  }
  struct Owned {
    const char* name;
    std::vector<std::string> strategies;
    bool given;
  };
  for (const auto& [name, strategies, given] :
       {Owned{"--rows", {"mrcs"}, options.rows > 0},
        Owned{"--columns", {"mrcs", "lightslice"}, options.columns > 0},
        Owned{"--slices", {"lightslice"}, options.slices > 0},
        Owned{"--sketch", {"mrcs"}, !options.sketch.empty()},
        Owned{"--column-scale", {"mrcs"}, options.columnScale != "scalar"},
        Owned{"--near-field", {"mrcs"}, options.nearField >= 0},
        Owned{"--error", {"mrcs"}, options.error > 0},
        Owned{"--sglc-mode", {"sglc"}, !options.cutMode.empty()},
        Owned{"--cut-size", {"sglc", "lightcuts", "stochastic"}, options.cutSize > 0},
        Owned{"--threshold", {"lightcuts", "stochastic"}, options.threshold >= 0}}) {
    if (given &&
        std::find(strategies.begin(), strategies.end(), options.gather) == strategies.end())
      throw UsageError(fmt::format("{} is for --gather {}; --gather {} has no use for it", name,
                                   fmt::join(strategies, ", "), options.gather));
  }
  requireSketch(options);
}

size_t slicesOf(const RenderOptions& options) {
  return options.slices > 0 ? options.slices : gather::SliceSettings().slices;
}
size_t sliceColumnsOf(const RenderOptions& options) {
  return options.columns > 0 ? options.columns : gather::SliceSettings().columns;
}

size_t gatheredLights(size_t lights, const RenderOptions& options) {
  // A light of a cut costs a few times a pair of brute force: choosing it.
  constexpr size_t kCostOfChoice = 4;
  if (options.gather == "sglc" || options.gather == "lightcuts" || options.gather == "stochastic")
    return std::min(lights, kCostOfChoice * cutSizeOf(options));
  if (options.gather == "lightslice") return std::min(lights, sliceColumnsOf(options));
  return options.gather == "mrcs" ? std::min(lights, mostColumns(options)) : lights;
}

LightGather::LightGather(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                         const BandPlan& plan, int set, LightParts parts,
                         const RenderOptions& options, Context& context)
    : tracer_(tracer), settings_(plan.gather), options_(options), parts_(std::move(parts)) {
  const uint64_t seed = hashCombine(hashCombine(context.seed, kStream), static_cast<uint64_t>(set));
  std::optional<Receivers> sample;  // for both parts
  const auto prepare = [&](const VirtualLights& lights, uint64_t number) -> Prepared {
    const uint64_t own = hashCombine(seed, number);
    if (lights.size() == 0 || context.cancelled()) return nullptr;
    if (options.gather == "sglc") {
      gather::CutGatherSettings settings =
          cutSettings(options, plan, camera.cropX1 - camera.cropX0);
      settings.seed = own;
      return std::make_unique<gather::LightCuts>(tracer, lights, settings, context);
    }
    if (options.gather == "lightcuts") {
      gather::LightcutsSettings settings = lightcutsSettings(options, plan);
      settings.seed = own;
      return std::make_unique<gather::Lightcuts>(tracer, lights, settings, context);
    }
    if (options.gather == "stochastic") {
      gather::StochasticSettings settings = stochasticSettings(options, plan);
      settings.seed = own;
      return std::make_unique<gather::StochasticLightcuts>(tracer, lights, settings, context);
    }
    if (options.gather != "lightslice") return nullptr;
    gather::SliceSettings settings = sliceSettings(options, plan);
    settings.seed = own;
    if (!sample) {
      const PixelSet pixels = choosePixelSample(camera, plan, slicedPixels(options), seed).pixels;
      sample = traceSample(tracer, emitters, camera, plan, set, pixels, context);
    }
    return std::make_unique<gather::LightSlices>(tracer, *sample, lights, settings, context);
  };
  direct_ = prepare(parts_.direct, 0);
  if (options.component != "direct") indirect_ = prepare(parts_.indirect, 1);
}

LightGather::Light LightGather::gather(const Receivers& run,
                                       const std::optional<GatherParts>& wanted, uint32_t onlyPixel,
                                       Context& context) const {
  Light light;
  light.direct.resize(run.points.size());
  light.indirect.resize(run.points.size());
  GatherSettings settings = settings_;
  settings.onlyPixel = onlyPixel;
  const auto add = [&](const VirtualLights& lights, const Prepared& prepared, size_t layer,
                       std::vector<Rgb>* sum) {
    if (lights.size() == 0) return;
    std::optional<GatherParts>& parts = light.layers[layer] = wanted;
    if (prepared) {
      prepared->gather(run, onlyPixel, *sum, context, parts ? &*parts : nullptr);
    } else {
      gatherAll(tracer_, run, lights, settings, *sum, context, parts ? &*parts : nullptr);
    }
  };
  add(parts_.direct, direct_, 0, &light.direct);
  add(parts_.nearDirect, {}, 1, &light.direct);
  if (options_.component == "direct") return light;
  add(parts_.indirect, indirect_, 2, &light.indirect);
  add(parts_.nearIndirect, {}, 3, &light.indirect);
  return light;
}

size_t LightGather::runLength() const {
  return app::runLength(gatheredLights(parts_.size(), options_));
}

}  // namespace lobelia::app
