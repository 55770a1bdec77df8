#include "lobelia/app/gather_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lobelia/app/light_reduction.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/base/error.h"
#include "lobelia/gather/gather_cuts.h"
#include "lobelia/gather/gather_pairs.h"
#include "lobelia/gather/illumination_cut.h"
#include "lobelia/gather/light_slices.h"
#include "lobelia/gather/lightcuts.h"
#include "lobelia/gather/multidimensional_lightcuts.h"
#include "lobelia/gather/rich_lights.h"
#include "lobelia/gather/stochastic_lightcuts.h"

namespace lobelia::app {
namespace {

// Of a cut that ends by --error.
constexpr size_t kMostNodesByError = 16384;

void requireMode(const RenderOptions& options) {
  if (options.gather != "sglc") return;
  const std::string mode = cutModeOf(options);
  const auto require = [&](const char* name, bool given, const char* modes) {
    if (given)
      throw UsageError(fmt::format("{} is for --sglc-mode {}; --sglc-mode {} has no use for it",
                                   name, modes, mode));
  };
  if (mode == "paper") {
    require("--cut-size", options.cutSize > 0, "shared or unbiased");
    return require("--error", options.error > 0, "shared or unbiased");
  }
  require("--threshold", options.threshold >= 0, "paper");
  require("--bound", !options.bound.empty(), "paper");
  require("--sglc-bounds", !options.boundForm.empty(), "paper");
  require("--sglc-share", !options.shared.empty(), "paper");
  require("--sglc-children", !options.children.empty(), "paper");
}

void requireRadiance(const RenderOptions& options) {
  if (options.lights != "richvpl") return;
  const bool cube = richRadianceOf(options) == "cube";
  if (options.richTexels > 0 && !cube)
    throw UsageError(
        "--richvpl-texels is for --richvpl-radiance cube; mixtures have "
        "--richvpl-lobes");
  if (options.richLobes > 0 && cube)
    throw UsageError("--richvpl-lobes is for --richvpl-radiance vmf; cubes have --richvpl-texels");
  if (options.richTexels % 2 != 0)
    throw UsageError(
        fmt::format("--richvpl-texels {} is odd; the half of a cube above a surface "
                    "has half of its texels, so an even number such as {} is needed",
                    options.richTexels, options.richTexels + 1));
}

}  // namespace

void requireGather(const RenderOptions& options) {
  if (options.gather != "all" && (options.lights == "path" || options.lights == "light")) {
    throw UsageError(fmt::format(
        "--gather {} gathers virtual lights and --lights {} has none; use vpl, glossy, vsl or vsgl",
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
        Owned{"--error", {"mrcs", "sglc"}, options.error > 0},
        Owned{"--sglc-mode", {"sglc"}, !options.cutMode.empty()},
        Owned{"--cut-size", {"sglc", "lightcuts", "mdlc", "stochastic"}, options.cutSize > 0},
        Owned{"--threshold",
              {"sglc", "lightcuts", "mdlc", "stochastic", "illumcut"},
              options.threshold >= 0},
        Owned{"--illumcut-rays", {"illumcut"}, !options.illumcutRays.empty()},
        Owned{"--export-trees", {"sglc", "lightcuts"}, !options.exportTrees.empty()},
        Owned{"--bound", {"sglc"}, !options.bound.empty()},
        Owned{"--sglc-bounds", {"sglc"}, !options.boundForm.empty()},
        Owned{"--sglc-share", {"sglc"}, !options.shared.empty()},
        Owned{"--sglc-children", {"sglc"}, !options.children.empty()}}) {
    if (given &&
        std::find(strategies.begin(), strategies.end(), options.gather) == strategies.end()) {
      if (!usesVirtualLights(options))
        throw UsageError(fmt::format(
            "{} is for strategies that gather virtual lights ({}) and --lights {} has none", name,
            fmt::join(strategies, ", "), options.lights));
      throw UsageError(fmt::format("{} is for --gather {}; --gather {} has no use for it", name,
                                   fmt::join(strategies, ", "), options.gather));
    }
  }
  requireMode(options);
  requireRadiance(options);
  requireSketch(options);
}

size_t gatheredLights(size_t lights, const RenderOptions& options) {
  // A light of a cut costs a few times a pair of brute force: choosing it.
  constexpr size_t kCostOfChoice = 2;
  // Of a receiver's pairs of nodes: as many receivers as a band has should share them.
  constexpr size_t kNodes = 2000;
  if (gathersPairs(options) || options.gather == "illumcut") return std::min(lights, kNodes);
  if (hasCutSize(options)) {
    // Hardly any cut that ends by its error grows to what it may have.
    const bool byError = options.error > 0 && options.cutSize == 0;
    const size_t nodes = byError ? gather::CutSettings().nodes : cutSizeOf(options);
    return std::min(lights, kCostOfChoice * nodes);
  }
  if (options.gather == "lightslice") return std::min(lights, sliceColumnsOf(options));
  if (options.lights == "richvpl") return std::min(lights, richLightsOf(options));
  return options.gather == "mrcs" ? std::min(lights, mostColumns(options)) : lights;
}

std::string cutModeOf(const RenderOptions& options) {
  return options.cutMode.empty() ? "shared" : options.cutMode;
}
size_t cutSizeOf(const RenderOptions& options) {
  if (options.cutSize > 0) return options.cutSize;
  if (options.gather == "lightcuts") return gather::LightcutsSettings().cutSize;
  if (options.gather == "mdlc") return gather::MultidimensionalSettings().cutSize;
  if (options.gather == "stochastic") return gather::StochasticSettings().cutSize;
  if (options.error > 0) return kMostNodesByError;
  return gather::CutSettings().nodes;
}

bool gathersPairs(const RenderOptions& options) {
  return options.gather == "sglc" && cutModeOf(options) == "paper";
}
bool gathersPixels(const RenderOptions& options) { return options.gather == "mdlc"; }
bool hasCutSize(const RenderOptions& options) {
  const std::string& gather = options.gather;
  return (gather == "sglc" && !gathersPairs(options)) || gather == "lightcuts" ||
         gather == "mdlc" || gather == "stochastic";
}
bool hasThreshold(const RenderOptions& options) {
  const std::string& gather = options.gather;
  return gathersPairs(options) || gather == "lightcuts" || gather == "mdlc" ||
         gather == "stochastic" || gather == "illumcut";
}
double thresholdOf(const RenderOptions& options) {
  if (options.threshold >= 0) return options.threshold;
  if (options.gather == "lightcuts") return gather::LightcutsSettings().threshold;
  if (options.gather == "mdlc") return gather::MultidimensionalSettings().threshold;
  if (options.gather == "stochastic") return gather::StochasticSettings().threshold;
  if (options.gather == "illumcut") return gather::IlluminationCutSettings().threshold;
  return gather::PairGatherSettings().threshold;
}
std::string boundOf(const RenderOptions& options) {
  return options.bound.empty() ? "approximate" : options.bound;
}
std::string boundFormOf(const RenderOptions& options) {
  return options.boundForm.empty() ? "tight" : options.boundForm;
}
std::string shareOf(const RenderOptions& options) {
  return options.shared.empty() ? "visibility" : options.shared;
}
std::string childrenOf(const RenderOptions& options) {
  return options.children.empty() ? "extent" : options.children;
}

uint64_t memoryOf(const RenderOptions& options) {
  return options.memory > 0 ? options.memory : gather::SliceSettings().memory;
}

std::string illumcutRaysOf(const RenderOptions& options) {
  return options.illumcutRays.empty() ? "sampled" : options.illumcutRays;
}

size_t slicesOf(const RenderOptions& options) {
  return options.slices > 0 ? options.slices : gather::SliceSettings().slices;
}
size_t sliceColumnsOf(const RenderOptions& options) {
  return options.columns > 0 ? options.columns : gather::SliceSettings().columns;
}

size_t richLightsOf(const RenderOptions& options) {
  return options.richLights > 0 ? options.richLights : gather::RichSettings().lights;
}
std::string richRadianceOf(const RenderOptions& options) {
  return options.richRadiance.empty() ? "vmf" : options.richRadiance;
}
int richTexelsOf(const RenderOptions& options) {
  return options.richTexels > 0 ? options.richTexels : gather::RichSettings().texels;
}
int richLobesOf(const RenderOptions& options) {
  return options.richLobes > 0 ? options.richLobes : gather::RichSettings().lobes;
}

}  // namespace lobelia::app
