// `lobelia precompute --method cuts`.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lobelia/app/load_scene.h"
#include "lobelia/app/precompute_methods.h"
#include "lobelia/app/precompute_report.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;
using relight::PrecomputeSettings;

PrecomputeSettings settingsOf(const PrecomputeOptions& options) {
  PrecomputeSettings settings = options.cuts;
  settings.light = options.light == "surfaces" ? relight::LightSamples::Kind::surfaces
                                               : relight::LightSamples::Kind::environment;
  settings.verifyAdaptive = options.adaptive == "verify";
  settings.adaptive = options.adaptive != "off";
  settings.ignoreBelowHorizon = options.horizon == "ignore";
  settings.subdivision = options.subdivision;
  return settings;
}

Json statisticsJson(const PrecomputeOptions& options, const Scene& scene,
                    const relight::VisibilityData& data, const Context& context) {
  const Statistics& s = context.statistics;
  const PrecomputeSettings& settings = options.cuts;
  const auto rays = static_cast<double>(s.count("shadow_rays"));
  const auto values = static_cast<double>(s.count("visibility_values"));
  Json json = contractStatistics(options, scene, context);
  json["lights"].update({{"model", options.light}, {"samples", data.samples.count()}});
  json["precompute"].update({{"light", options.light},
                             {"sigma", settings.sigma},
                             {"max_cut", settings.mostNodes},
                             {"beta", settings.beta},
                             {"clusters", settings.clusterCount},
                             {"subdivide", options.subdivision},
                             {"adaptive", options.adaptive},
                             {"horizon", options.horizon}});
  json["cuts"] = {{"size", s.value("cut_size")},
                  {"rms", s.value("cut_rms")},
                  {"rms_all_samples", s.value("cut_rms_all")}};
  for (const char* stage : {"samples", "subdivision", "pilot", "trees", "visibility"})
    json["seconds"][stage] = s.seconds(stage);
  Json& counts = json["counts"];
  for (const char* name : {"vertices", "vertices_added", "shadow_rays", "pilot_rays",
                           "subdivision_rays", "visibility_values", "cut_nodes", "cuts_capped"})
    counts[name] = s.count(name);
  counts["samples"] = data.samples.count();
  counts["rays_per_value"] = ratio(rays, values);
  if (options.adaptive == "verify") {
    counts["adaptive_wrong"] = s.count("adaptive_wrong");
    counts["adaptive_rms"] =
        std::sqrt(ratio(static_cast<double>(s.count("adaptive_wrong")), values));
  }
  json["rays_per_second"] = ratio(rays, s.seconds("visibility"));
  return json;
}

std::string summary(const PrecomputeOptions& options, const Context& context) {
  const Statistics& s = context.statistics;
  const auto rays = static_cast<double>(s.count("shadow_rays"));
  return fmt::format(
      "{} vertices ({} of them added), cuts of {:.1f} nodes, RMS error {:.4f}; {:.4g} million "
      "rays, {:.4g} million a second; {:.1f} MB in {:.1f} s",
      s.count("vertices"), s.count("vertices_added"), s.value("cut_size"), s.value("cut_rms"),
      rays * 1e-6, ratio(rays, s.seconds("visibility")) * 1e-6,
      static_cast<double>(outputBytes(options)) * 1e-6, s.seconds("total"));
}

}  // namespace

void precomputeCuts(const PrecomputeOptions& options, Context& context) {
  const int64_t start = nanosecondsNow();
  const Scene scene = loadScene(options.scene, context);
  const Tracer tracer(scene, context);
  const relight::VisibilityData data =
      relight::precomputeVisibility(tracer, settingsOf(options), context);
  {
    const StageTimer timer(context, "save");
    relight::save(data, scene, options.output);
  }
  context.statistics.addSeconds("total", static_cast<double>(nanosecondsNow() - start) * 1e-9);
  context.info(summary(options, context));
  writeStatistics(options, statisticsJson(options, scene, data, context));
}

}  // namespace lobelia::app
