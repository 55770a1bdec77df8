#include "lobelia/app/methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "lobelia/base/error.h"

namespace lobelia::app {

const std::vector<LightModel>& lightModels() {
  static const std::vector<std::string> everyStrategy{
      "all", "mrcs", "lightslice", "lightcuts", "mdlc", "stochastic", "illumcut", "sglc"};
  static const std::vector<LightModel> models{
      {"path",
       "reference path tracing: next-event estimation and BSDF sampling, no virtual lights",
       {}},
      {"light", "light tracing: particles connected to the camera (a check; blind to mirrors)", {}},
      {"photon",
       "photon mapping with final gathering: photons around what receivers' rays meet",
       {}},
      {"vpl", "diffuse virtual point lights only, clamped by default", everyStrategy},
      {"glossy", "diffuse and spherical-Gaussian lights", everyStrategy},
      {"vsl", "virtual spherical lights: any material at both ends, no spikes, no clamp",
       everyStrategy},
      {"vsgl",
       "virtual spherical Gaussian lights: clusters of point lights with an extent, no spikes",
       {"all", "mrcs", "sglc"}},
      {"richvpl",
       "Rich-VPLs: few places send out, by directions, all diffuse and glossy light around them",
       {"all"}},
  };
  return models;
}

const std::vector<GatherStrategy>& gatherStrategies() {
  static const std::vector<GatherStrategy> strategies{
      {"all", "every light at every receiver (brute force, the reference of all strategies)"},
      {"mrcs",
       "matrix row-column sampling: few lights stand for all, chosen by a sample of pixels"},
      {"lightslice",
       "LightSlice: groups of like receivers have few lights of their own that stand for all"},
      {"lightcuts",
       "Lightcuts: every receiver has a cut of a light tree of its own, refined by upper bounds"},
      {"mdlc",
       "multidimensional lightcuts: all samples of a pixel share a cut, of pairs of light and "
       "receiver nodes"},
      {"stochastic",
       "stochastic lightcuts: as lightcuts, with one light drawn below every node, without bias"},
      {"illumcut",
       "IlluminationCut: pairs of light and receiver nodes, refined by upper bounds against a "
       "coarse picture"},
      {"sglc",
       "shared stochastic cuts: neighbouring receivers share lights drawn by a cut of a light "
       "tree; --sglc-mode paper: pairs of light and receiver nodes, refined by bounds"},
  };
  return strategies;
}

namespace {

template <class T>
std::vector<std::string> names(const std::vector<T>& items) {
  std::vector<std::string> out;
  for (const T& item : items) out.push_back(item.name);
  return out;
}

template <class T>
const T& find(const std::vector<T>& items, const std::string& name, const char* what) {
  const auto it =
      std::find_if(items.begin(), items.end(), [&](const T& i) { return i.name == name; });
  if (it != items.end()) return *it;
  throw UsageError(fmt::format("{} '{}' is not known; there are {}{}", what, name,
                               fmt::join(names(items), ", "), suggestion(name, names(items))));
}

}  // namespace

std::vector<std::string> lightModelNames() { return names(lightModels()); }
std::vector<std::string> gatherStrategyNames() { return names(gatherStrategies()); }

void requireMethod(const std::string& lights, const std::string& gather) {
  const LightModel& model = find(lightModels(), lights, "--lights");
  find(gatherStrategies(), gather, "--gather");
  if (model.gathers.empty()) return;
  if (std::find(model.gathers.begin(), model.gathers.end(), gather) != model.gathers.end()) return;
  throw UsageError(fmt::format("--lights {} does not combine with --gather {}; it does with {}",
                               lights, gather, fmt::join(model.gathers, ", ")));
}

std::string methodTable() {
  std::string out = "Light models (--lights):\n";
  for (const LightModel& m : lightModels()) out += fmt::format("  {:<8} {}\n", m.name, m.summary);
  out += "\nGather strategies (--gather):\n";
  for (const GatherStrategy& g : gatherStrategies())
    out += fmt::format("  {:<10} {}\n", g.name, g.summary);
  out += "\nWhat combines:\n  " + fmt::format("{:<8}", "");
  for (const GatherStrategy& g : gatherStrategies()) out += fmt::format(" {:<10}", g.name);
  out += "\n";
  for (const LightModel& m : lightModels()) {
    out += fmt::format("  {:<8}", m.name);
    for (const GatherStrategy& g : gatherStrategies()) {
      const bool yes = std::find(m.gathers.begin(), m.gathers.end(), g.name) != m.gathers.end();
      out += fmt::format(" {:<10}", m.gathers.empty() ? "(none)" : yes ? "yes" : "-");
    }
    out += "\n";
  }
  return out;
}

}  // namespace lobelia::app
