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

gather::PairGatherSettings pairSettingsFor(const RenderOptions& options, const BandPlan& plan) {
  using gather::TraversalSettings;
  gather::PairGatherSettings settings;
  settings.gather = plan.gather;
  settings.threshold = thresholdOf(options);
  if (boundOf(options) == "conservative")
    settings.traversal.error = TraversalSettings::Error::conservative;
  if (options.boundForm == "corrected") settings.traversal.bounds = gather::BoundForm::corrected;
  if (options.children == "paper")
    settings.traversal.children = TraversalSettings::ChildRule::paper;
  if (options.shared == "radiance") settings.share = gather::Share::radiance;
  return settings;
}

void requireMode(const RenderOptions& options) {
  if (options.gather != "sglc") return;
  const std::string mode = cutModeOf(options);
  const auto require = [&](const char* name, bool given, const char* modes) {
    if (given)
      throw UsageError(fmt::format("{} is for --sglc-mode {}; --sglc-mode {} has no use for it",
                                   name, modes, mode));
  };
  if (mode == "paper") return require("--cut-size", options.cutSize > 0, "shared or unbiased");
  require("--threshold", options.threshold >= 0, "paper");
  require("--bound", !options.bound.empty(), "paper");
  require("--sglc-bounds", !options.boundForm.empty(), "paper");
  require("--sglc-share", !options.shared.empty(), "paper");
  require("--sglc-children", !options.children.empty(), "paper");
}

}  // namespace

bool gathersPairs(const RenderOptions& options) {
  return options.gather == "sglc" && cutModeOf(options) == "paper";
}
float thresholdOf(const RenderOptions& options) {
  return options.threshold >= 0 ? options.threshold : gather::PairGatherSettings().threshold;
}
std::string boundOf(const RenderOptions& options) {
  return options.bound.empty() ? "approximate" : options.bound;
}

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
        Owned{"--cut-size", "sglc", options.cutSize > 0},
        Owned{"--threshold", "sglc", options.threshold >= 0},
        Owned{"--bound", "sglc", !options.bound.empty()},
        Owned{"--sglc-bounds", "sglc", !options.boundForm.empty()},
        Owned{"--sglc-share", "sglc", !options.shared.empty()},
        Owned{"--sglc-children", "sglc", !options.children.empty()}}) {
    if (given && options.gather != strategy)
      throw UsageError(fmt::format("{} is for --gather {}; --gather {} has no use for it", name,
                                   strategy, options.gather));
  }
  requireMode(options);
  requireSketch(options);
}

size_t gatheredLights(size_t lights, const RenderOptions& options) {
  // A light of a cut costs a few times a pair of brute force: choosing it.
  constexpr size_t kCostOfChoice = 4;
  // Of a receiver's pairs of nodes: as many receivers as a band has should share them.
  constexpr size_t kNodes = 2000;
  if (gathersPairs(options)) return std::min(lights, kNodes);
  if (options.gather == "sglc") return std::min(lights, kCostOfChoice * cutSizeOf(options));
  return options.gather == "mrcs" ? std::min(lights, mostColumns(options)) : lights;
}

LightGather::LightGather(const Tracer& tracer, const BandPlan& plan, int set, int width,
                         LightParts parts, const RenderOptions& options, Context& context)
    : tracer_(tracer), settings_(plan.gather), options_(options), parts_(std::move(parts)) {
  if (options.gather != "sglc") return;
  gather::CutGatherSettings cuts = settingsFor(options, plan, width);
  gather::PairGatherSettings pairs = pairSettingsFor(options, plan);
  const uint64_t seed = hashCombine(hashCombine(context.seed, kStream), static_cast<uint64_t>(set));
  for (const auto& [lights, trees, number] :
       {std::tuple{&parts_.direct, &direct_, 0}, std::tuple{&parts_.indirect, &indirect_, 1}}) {
    cuts.seed = pairs.seed = hashCombine(seed, static_cast<uint64_t>(number));
    if (number == 1 && options.component == "direct") continue;
    if (lights->size() == 0) continue;
    if (gathersPairs(options)) {
      trees->pairs.emplace(tracer, *lights, pairs, context);
    } else {
      trees->cuts.emplace(tracer, *lights, cuts, context);
    }
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
  const auto add = [&](const VirtualLights& lights, const Trees& trees, size_t layer,
                       std::vector<Rgb>* sum) {
    if (lights.size() == 0) return;
    std::optional<GatherParts>& parts = light.layers[layer] = wanted;
    if (trees.pairs) {
      trees.pairs->gather(run, *sum, context, parts ? &*parts : nullptr);
    } else if (trees.cuts) {
      trees.cuts->gather(run, onlyPixel, *sum, context, parts ? &*parts : nullptr);
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
