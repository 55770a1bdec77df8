// The strategies of `lobelia methods`, so that new ones take part by themselves, Rich-VPLs of the
// same lights, and what sets the quality of each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/bench_sglc.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/app/methods.h"
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

constexpr const char* kPaper = "sglc-paper";

void setCutSize(RenderOptions& o, double v) { o.cutSize = static_cast<size_t>(v); }
void setThreshold(RenderOptions& o, double v) { o.threshold = v; }
void setColumns(RenderOptions& o, double v) { o.columns = static_cast<size_t>(v); }
void setRichLights(RenderOptions& o, double v) { o.richLights = static_cast<size_t>(v); }

// By the beginning of a method's key. Strategies that are not here have one point in figure 8,
// that of their defaults.
const std::vector<std::pair<std::string, SglcQuality>>& qualities() {
  static const double cut = static_cast<double>(gather::CutSettings().nodes);
  static const double threshold = gather::PairGatherSettings().threshold;
  static const double lightcuts = gather::LightcutsSettings().threshold;
  static const double mdlc = gather::MultidimensionalSettings().threshold;
  static const double columns = static_cast<double>(gather::SliceSettings().columns);
  static const double stochastic = static_cast<double>(gather::StochasticSettings().cutSize);
  static const double illumcut = gather::IlluminationCutSettings().threshold;
  static const double rich = static_cast<double>(gather::RichSettings().lights);
  static const std::vector<std::pair<std::string, SglcQuality>> table{
      {kPaper, {"--threshold", threshold, {0.08, 0.04, 0.02, threshold}, setThreshold}},
      {"sglc", {"--cut-size", cut, {cut / 16, cut / 4, cut, 4 * cut}, setCutSize}},
      {"mrcs", {"--columns", cut, {cut / 4, cut, 4 * cut}, setColumns}},
      {"lightslice", {"--columns", columns, {columns / 4, columns, 4 * columns}, setColumns}},
      {"lightcuts", {"--threshold", lightcuts, {0.08, 0.04, lightcuts, 0.01}, setThreshold}},
      {"mdlc", {"--threshold", mdlc, {0.08, 0.04, mdlc, 0.01}, setThreshold}},
      {"illumcut", {"--threshold", illumcut, {0.08, 0.04, 0.02, illumcut}, setThreshold}},
      {"richvpl", {"--richvpl-lights", rich, {rich / 16, rich / 4, rich, 4 * rich}, setRichLights}},
      {"stochastic", {"--cut-size", stochastic, {64, stochastic, 1024}, setCutSize}},
  };
  return table;
}

SglcMethod byMode(const std::string& mode) {
  return {"sglc-" + mode, "sglc, " + mode, [mode](RenderOptions& options) {
            options.gather = "sglc";
            options.cutMode = mode;
          }};
}

// The same lights, merged; gathered by brute force.
SglcMethod byRadiance(const std::string& form) {
  return {"richvpl-" + form, "richvpl, " + form, [form](RenderOptions& options) {
            options.lights = "richvpl";
            options.richRadiance = form;
          }};
}

// As many lights as a cut of sglc has: by its own error, mrcs takes most lights of small sets.
SglcMethod byColumns() {
  const size_t columns = gather::CutSettings().nodes;
  return {"mrcs", "mrcs", [columns](RenderOptions& options) {
            options.gather = "mrcs";
            options.columns = columns;
          }};
}

bool gathersGlossyLights(const std::string& strategy) {
  return std::any_of(lightModels().begin(), lightModels().end(), [&](const LightModel& model) {
    return model.name == "glossy" &&
           std::find(model.gathers.begin(), model.gathers.end(), strategy) != model.gathers.end();
  });
}

std::vector<SglcMethod> allMethods() {
  std::vector<SglcMethod> methods;
  for (const GatherStrategy& strategy : gatherStrategies()) {
    if (strategy.name == "all" || !gathersGlossyLights(strategy.name)) continue;
    if (strategy.name == "sglc") {
      for (const char* mode : {"shared", "unbiased", "paper"}) methods.push_back(byMode(mode));
    } else if (strategy.name == "mrcs") {
      methods.push_back(byColumns());
    } else {
      methods.push_back({strategy.name, strategy.name,
                         [name = strategy.name](RenderOptions& o) { o.gather = name; }});
    }
  }
  for (const char* form : {"cube", "vmf"}) methods.push_back(byRadiance(form));
  return methods;
}

}  // namespace

const std::vector<std::string>& sglcMethodKeys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> all;
    for (const SglcMethod& method : allMethods()) all.push_back(method.key);
    return all;
  }();
  return keys;
}

std::vector<SglcMethod> sglcMethods(const SglcSettings& settings) {
  std::vector<SglcMethod> methods = allMethods();
  std::erase_if(methods, [&](const SglcMethod& method) {
    return method.key != defaultMethod().key && !settings.methods.contains(method.key);
  });
  return methods;
}

SglcMethod everyLight() {
  return {"all", "every light", [](RenderOptions& options) { options.gather = "all"; }};
}
SglcMethod defaultMethod() { return byMode("shared"); }
SglcMethod approximateMethod() { return byMode("paper"); }

SglcMethod conservative(SglcMethod paper) {
  paper.key += "-conservative";
  paper.label += ", E_c";
  paper.change = [inner = paper.change](RenderOptions& options) {
    inner(options);
    options.bound = "conservative";
  };
  return paper;
}

SglcMethod withLayers(SglcMethod method) {
  method.key += "-layers";
  method.change = [inner = method.change](RenderOptions& options) {
    inner(options);
    options.aovs = "types,cost";
  };
  return method;
}

const SglcQuality* qualityOf(const SglcMethod& method) {
  for (const auto& [prefix, quality] : qualities())
    if (method.key.starts_with(prefix)) return &quality;
  return nullptr;
}

SglcMethod withQuality(SglcMethod method, const SglcQuality& quality, double value) {
  if (value == quality.normal) return method;
  method.key += fmt::format("-{:g}", value);
  method.change = [inner = method.change, set = quality.set, value](RenderOptions& options) {
    inner(options);
    set(options, value);
  };
  return method;
}

}  // namespace lobelia::app
