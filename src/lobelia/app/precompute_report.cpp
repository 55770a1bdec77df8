#include "lobelia/app/precompute_report.h"

#include <sys/resource.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "lobelia/base/file.h"
#include "lobelia/version.h"

namespace lobelia::app {

using Json = nlohmann::ordered_json;

uint64_t outputBytes(const PrecomputeOptions& options) {
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(options.output, error);
  return error ? 0 : bytes;
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

Json contractStatistics(const PrecomputeOptions& options, const Scene& scene,
                        const Context& context) {
  const Statistics& s = context.statistics;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  Json seconds = Json::object(), counts = Json::object();
  for (const char* stage : {"load", "accel", "save", "total"}) seconds[stage] = s.seconds(stage);
  for (const char* stage : {"receivers", "lights", "trees", "traverse", "visibility", "shade"})
    seconds[stage] = 0;
  for (const char* name :
       {"node_pairs_visited", "node_pairs_shaded", "specular_connections", "rays_per_pixel",
        "cut_nodes_per_pixel", "lights_per_light_node", "pixels_per_pixel_node", "nonfinite"})
    counts[name] = 0;
  Json lights = Json::object();
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
          {"precompute", {{"method", options.method}}},
          {"seconds", std::move(seconds)},
          {"counts", std::move(counts)},
          {"memory",
           {{"peak_bytes", static_cast<uint64_t>(usage.ru_maxrss) * 1024},
            {"embree_bytes", s.value("embree_bytes")},
            {"bytes_per_light", 0},
            {"bytes_per_receiver", 0},
            {"file_bytes", outputBytes(options)}}}};
}

void writeStatistics(const PrecomputeOptions& options, const Json& statistics) {
  if (options.stats.empty()) return;
  const std::string text = statistics.dump(2) + "\n";
  writeFileAtomically(options.stats, std::as_bytes(std::span<const char>(text)));
}

}  // namespace lobelia::app
