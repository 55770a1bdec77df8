#include "lobelia/app/light_gather.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/base/error.h"
#include "lobelia/base/random.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kStream = 0x73676c63;  // of everything random here

gather::CutGatherSettings settingsFor(const RenderOptions& options, const BandPlan& plan,
                                      int width) {
  gather::CutGatherSettings settings;
  settings.gather = plan.gather;
  settings.cut.nodes = cutSizeOf(options);
  settings.shared = cutModeOf(options) == "shared";
  settings.width = width;
  return settings;
}

}  // namespace

std::string cutModeOf(const RenderOptions& options) {
  return options.cutMode.empty() ? "shared" : options.cutMode;
}
size_t cutSizeOf(const RenderOptions& options) {
  return options.cutSize > 0 ? options.cutSize : gather::CutSettings().nodes;
}

void requireGather(const RenderOptions& options) {
  if (options.gather != "all" && (options.lights == "path" || options.lights == "light")) {
    throw UsageError(fmt::format(
        "--gather {} gathers virtual lights and --lights {} has none; use vpl, glossy or vsl",
        options.gather, options.lights));
  }
  struct Owned {
    const char *name, *strategy;
    bool given;
  };
  for (const auto& [name, strategy, given] :
       {Owned{"--rows", "mrcs", options.rows > 0}, Owned{"--columns", "mrcs", options.columns > 0},
        Owned{"--sketch", "mrcs", !options.sketch.empty()},
        Owned{"--column-scale", "mrcs", options.columnScale != "scalar"},
        Owned{"--near-field", "mrcs", options.nearField >= 0},
        Owned{"--error", "mrcs", options.error > 0},
        Owned{"--sglc-mode", "sglc", !options.cutMode.empty()},
        Owned{"--cut-size", "sglc", options.cutSize > 0}}) {
    if (given && options.gather != strategy)
      throw UsageError(fmt::format("{} is for --gather {}; --gather {} has no use for it", name,
                                   strategy, options.gather));
  }
  requireSketch(options);
}

size_t gatheredLights(size_t lights, const RenderOptions& options) {
  // A light of a cut costs a few times a pair of brute force: choosing it.
  constexpr size_t kCostOfChoice = 4;
  if (options.gather == "sglc") return std::min(lights, kCostOfChoice * cutSizeOf(options));
  return options.gather == "mrcs" ? std::min(lights, mostColumns(options)) : lights;
}

LightGather::LightGather(const Tracer& tracer, const BandPlan& plan, int set, int width,
                         LightParts parts, const RenderOptions& options, Context& context)
    : tracer_(tracer), settings_(plan.gather), options_(options), parts_(std::move(parts)) {
  if (options.gather != "sglc") return;
  gather::CutGatherSettings settings = settingsFor(options, plan, width);
  const uint64_t seed = hashCombine(hashCombine(context.seed, kStream), static_cast<uint64_t>(set));
  for (const auto& [lights, cuts, number] : {std::tuple{&parts_.direct, &directCuts_, 0},
                                             std::tuple{&parts_.indirect, &indirectCuts_, 1}}) {
    settings.seed = hashCombine(seed, static_cast<uint64_t>(number));
    if (number == 1 && options.component == "direct") continue;
    if (lights->size() > 0) cuts->emplace(tracer, *lights, settings, context);
  }
}

LightGather::Light LightGather::gather(const Receivers& run,
                                       const std::optional<GatherParts>& wanted, uint32_t onlyPixel,
                                       Context& context) const {
  Light light;
  light.direct.resize(run.points.size());
  light.indirect.resize(run.points.size());
  GatherSettings settings = settings_;
  settings.onlyPixel = onlyPixel;
  const auto add = [&](const VirtualLights& lights, const std::optional<gather::LightCuts>& cuts,
                       size_t layer, std::vector<Rgb>* sum) {
    if (lights.size() == 0) return;
    std::optional<GatherParts>& parts = light.layers[layer] = wanted;
    if (cuts) {
      cuts->gather(run, onlyPixel, *sum, context, parts ? &*parts : nullptr);
    } else {
      gatherAll(tracer_, run, lights, settings, *sum, context, parts ? &*parts : nullptr);
    }
  };
  add(parts_.direct, directCuts_, 0, &light.direct);
  add(parts_.nearDirect, {}, 1, &light.direct);
  if (options_.component == "direct") return light;
  add(parts_.indirect, indirectCuts_, 2, &light.indirect);
  add(parts_.nearIndirect, {}, 3, &light.indirect);
  return light;
}

size_t LightGather::runLength() const {
  return app::runLength(gatheredLights(parts_.size(), options_));
}

}  // namespace lobelia::app
