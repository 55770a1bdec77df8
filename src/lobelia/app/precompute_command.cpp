#include "lobelia/app/precompute_command.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/signals.h"
#include "lobelia/base/file.h"
#include "lobelia/base/parallel.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;
using relight::PrecomputeSettings;

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names{"cuts", "vmf"};
  return names;
}

CLI::Validator powerOfTwo(uint64_t least, uint64_t most) {
  return CLI::Validator(
      [=](const std::string& text) {
        uint64_t value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::has_single_bit(value) &&
            value >= least && value <= most)
          return std::string();
        return fmt::format("{} is not a power of two from {} to {}", text, least, most);
      },
      "");
}

PrecomputeSettings settingsOf(const PrecomputeOptions& options) {
  PrecomputeSettings settings = options.settings;
  settings.light = options.light == "surfaces" ? relight::LightSamples::Kind::surfaces
                                               : relight::LightSamples::Kind::environment;
  settings.adaptive = options.adaptive == "on";
  settings.verifyAdaptive = options.adaptive == "verify";
  if (settings.verifyAdaptive) settings.adaptive = true;
  settings.ignoreBelowHorizon = options.horizon == "ignore";
  return settings;
}

uint64_t fileBytes(const std::string& file) {  // 0: of a device
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(file, error);
  return error ? 0 : bytes;
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

// The contract's keys, of which those of rendering are 0 here, and what there is to tell of the
// data.
Json statisticsJson(const PrecomputeOptions& options, const Scene& scene,
                    const relight::VisibilityData& data, const Context& context) {
  const Statistics& s = context.statistics;
  const PrecomputeSettings& settings = options.settings;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const uint64_t rays = s.count("shadow_rays");
  const double values = static_cast<double>(s.count("visibility_values"));
  Json seconds = Json::object();
  for (const char* stage :
       {"load", "accel", "samples", "subdivision", "pilot", "trees", "visibility", "save", "total"})
    seconds[stage] = s.seconds(stage);
  Json counts = {{"vertices", s.count("vertices")},
                 {"vertices_added", s.count("vertices_added")},
                 {"samples", data.samples.count()},
                 {"shadow_rays", rays},
                 {"pilot_rays", s.count("pilot_rays")},
                 {"subdivision_rays", s.count("subdivision_rays")},
                 {"visibility_values", s.count("visibility_values")},
                 {"rays_per_value", ratio(static_cast<double>(rays), values)},
                 {"cut_nodes", s.count("cut_nodes")},
                 {"cuts_capped", s.count("cuts_capped")}};
  if (options.adaptive == "verify") {
    const double wrong = static_cast<double>(s.count("adaptive_wrong"));
    counts["adaptive_wrong"] = s.count("adaptive_wrong");
    counts["adaptive_rms"] = std::sqrt(ratio(wrong, values));
  }
  for (const char* name :
       {"node_pairs_visited", "node_pairs_shaded", "specular_connections", "rays_per_pixel",
        "cut_nodes_per_pixel", "lights_per_light_node", "pixels_per_pixel_node", "nonfinite"})
    counts[name] = 0;
  for (const char* stage : {"receivers", "lights", "traverse", "shade"}) seconds[stage] = 0;
  Json lights = {{"model", options.light}, {"samples", data.samples.count()}};
  for (const char* kind : {"omni", "directional", "diffuse", "glossy", "spherical", "vsgl"})
    lights[kind] = 0;
  return {{"version", kVersion},
          {"seed", options.seed},
          {"lights", std::move(lights)},
          {"gather",
           {{"strategy", "none"},
            {"mode", ""},
            {"bound", ""},
            {"threshold", nullptr},
            {"error", nullptr}}},
          {"receivers", {{"diffuse", 0}, {"glossy", 0}}},
          {"scene",
           {{"triangles", triangleCount(scene)},
            {"materials", scene.materials.size()},
            {"emitters", scene.emitters.size()}}},
          {"precompute",
           {{"method", options.method},
            {"light", options.light},
            {"sigma", settings.sigma},
            {"max_cut", settings.mostNodes},
            {"beta", settings.beta},
            {"clusters", settings.clusterCount},
            {"subdivide", settings.subdivision},
            {"adaptive", options.adaptive},
            {"horizon", options.horizon}}},
          {"cuts",
           {{"size", s.value("cut_size")},
            {"rms", s.value("cut_rms")},
            {"rms_all_samples", s.value("cut_rms_all")}}},
          {"seconds", std::move(seconds)},
          {"counts", std::move(counts)},
          {"rays_per_second", ratio(static_cast<double>(rays), s.seconds("visibility"))},
          {"memory",
           {{"peak_bytes", static_cast<uint64_t>(usage.ru_maxrss) * 1024},
            {"embree_bytes", s.value("embree_bytes")},
            {"bytes_per_light", 0},
            {"bytes_per_receiver", 0},
            {"file_bytes", fileBytes(options.output)}}}};
}

std::string summary(const PrecomputeOptions& options, const Context& context) {
  const Statistics& s = context.statistics;
  return fmt::format(
      "{} vertices ({} of them added), cuts of {:.1f} nodes, RMS error {:.4f}; {:.4g} million "
      "rays, {:.4g} million a second; {:.1f} MB in {:.1f} s",
      s.count("vertices"), s.count("vertices_added"), s.value("cut_size"), s.value("cut_rms"),
      static_cast<double>(s.count("shadow_rays")) * 1e-6,
      ratio(static_cast<double>(s.count("shadow_rays")), s.seconds("visibility")) * 1e-6,
      static_cast<double>(fileBytes(options.output)) * 1e-6, s.seconds("total"));
}

void run(const PrecomputeOptions& options, Context& context) {
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
  if (options.stats.empty()) return;
  const std::string text = statisticsJson(options, scene, data, context).dump(2) + "\n";
  writeFileAtomically(options.stats, std::as_bytes(std::span<const char>(text)));
}

}  // namespace

void addPrecomputeOptions(CLI::App& c, PrecomputeOptions& o) {
  addSceneOptions(c, o.scene);
  c.add_option("--method", o.method, "What is precomputed; cuts: visibility cuts at vertices")
      ->type_name("METHOD")
      ->check(offered(methodNames()))
      ->required();
  c.add_option("-o,--output", o.output, "Data to write")->type_name("FILE")->required();
  c.add_option("--light", o.light,
               "Light that will be looked for: from all directions (environment), or from the "
               "scene's surfaces, for one bounce of local light (surfaces)")
      ->type_name("WHICH")
      ->check(oneOf({"environment", "surfaces"}))
      ->capture_default_str();
  PrecomputeSettings& s = o.settings;
  c.add_option("--samples", s.sampleCount,
               "Samples of light: directions, or places on surfaces; a power of two, at least 256")
      ->type_name("N")
      ->check(powerOfTwo(256, 32768))
      ->capture_default_str();
  c.add_option("--sigma", s.sigma,
               "Error that each node of a cut may have: the root of its summed squared "
               "differences; 0: none")
      ->type_name("X")
      ->check(finiteNumber(0, 1000))
      ->capture_default_str();
  c.add_option("--max-cut", s.mostNodes, "Nodes of a cut, at most")
      ->type_name("N")
      ->check(integerRange(1, 32768))
      ->capture_default_str();
  c.add_option("--beta", s.beta,
               "Clusters of samples go by geometry (1), by what parts of the scene see of them "
               "(0), or by a mix of both")
      ->type_name("X")
      ->check(finiteNumber(0, 1))
      ->capture_default_str();
  c.add_option("--clusters", s.clusterCount,
               "Clusters of vertices that are asked what they see; a power of two")
      ->type_name("N")
      ->check(powerOfTwo(1, 16384))
      ->capture_default_str();
  c.add_option("--subdivide", s.subdivision,
               "How often edges are halved at most where visibility differs along them; 0: never")
      ->type_name("N")
      ->check(integerRange(0, 8))
      ->capture_default_str();
  c.add_option(
       "--adaptive", o.adaptive,
       "Trace few rays where vertices nearby agree (on), or all (off); verify: few, and all "
       "as well, to count in the statistics what differs")
      ->type_name("WHICH")
      ->check(oneOf({"on", "off", "verify"}))
      ->capture_default_str();
  c.add_option("--horizon", o.horizon,
               "Light from behind an opaque surface: what cuts say of it does not matter (ignore), "
               "or they say that it is blocked (keep), which makes them larger")
      ->type_name("WHICH")
      ->check(oneOf({"ignore", "keep"}))
      ->capture_default_str();
  c.add_option("--seed", o.seed, "Seed of all random choices")
      ->type_name("N")
      ->check(seedNumber())
      ->capture_default_str();
  c.add_option("--stats", o.stats, "Write statistics as JSON")->type_name("FILE");
}

ExitCode precompute(const PrecomputeOptions& options, const GlobalOptions& global) {
  if (options.method == "vmf") throw UsageError("--method vmf is not built yet; there is cuts");
  if (options.method != "cuts") {
    throw UsageError(fmt::format("--method '{}' is not known{}", options.method,
                                 suggestion(options.method, methodNames())));
  }
  for (const std::string& file : {options.output, options.stats})
    if (!file.empty()) requireWritable(file);
  if (options.output == options.stats)
    throw UsageError(
        fmt::format("{} would be written twice; give each output its own name", options.output));
  requireNoInput({options.output, options.stats},
                 {options.scene.scene, options.scene.design, options.scene.environment});
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.seed;
  const SignalGuard signals(context);
  try {
    run(options, context);
    return ExitCode::done;
  } catch (const Cancelled&) {
    context.warning("stopped: the data is not complete, none is written");
    return signalExitCode();
  }
}

}  // namespace lobelia::app
