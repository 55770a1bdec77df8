#include "lobelia/app/statistics_file.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <span>

#include "lobelia/app/gather_options.h"
#include "lobelia/base/file.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;

uint64_t peakBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

Json secondsJson(const Statistics& statistics) {
  Json out;
  for (const char* stage :
       {"load", "accel", "receivers", "lights", "trees", "traverse", "rows", "cluster",
        "visibility", "shade", "compensate", "final_gather", "trace", "total"}) {
    out[stage] = statistics.seconds(stage);
  }
  return out;
}

// Where receivers share lights that stand for others: how many each stands for, how many receivers
// share it. Else 1 each.
double lightsPerNode(const VirtualLightReport& report, const Statistics& s) {
  if (s.count("cut_lights") == 0) return report.lights.total > 0 ? 1 : 0;
  return ratio(static_cast<double>(s.count("clustered_lights")),
               static_cast<double>(s.count("cut_lights")));
}
double pointsPerCluster(const VirtualLightReport& report, const Statistics& s) {
  if (s.count("receiver_clusters") == 0) return report.receiverPoints > 0 ? 1 : 0;
  return ratio(static_cast<double>(s.count("clustered_receivers")),
               static_cast<double>(s.count("receiver_clusters")));
}

}  // namespace

void writeStatistics(const std::string& file, const RenderOptions& options, const Scene& scene,
                     const Film& film, const VirtualLightReport& report, const Context& context) {
  const Statistics& s = context.statistics;
  const LightCounts& lights = report.lights;
  const bool gathers =
      options.lights != "path" && options.lights != "light" && options.lights != "photon";
  const bool pairs = gathers && gathersPairs(options);
  const bool bounded = gathers && hasThreshold(options);
  size_t pixels = film.pixelCount();
  if (!film.alpha.empty()) {
    pixels = static_cast<size_t>(std::count(film.alpha.begin(), film.alpha.end(), 1.f));
  }
  const double shadowRays = static_cast<double>(s.count("shadow_rays"));
  const auto countOf = [&](gather::LightClass lightClass) {
    return lights.byClass[static_cast<size_t>(lightClass)];
  };
  const double receivers = static_cast<double>(report.diffuseReceivers + report.glossyReceivers);
  const double receiverBytes =
      static_cast<double>(report.receiverPoints) * sizeof(ReceiverPoint) + receivers * sizeof(Lobe);
  Json json;
  json["version"] = kVersion;
  json["scene"] = {{"triangles", triangleCount(scene)},
                   {"materials", scene.materials.size()},
                   {"emitters", scene.emitters.size()}};
  json["lights"] = {{"model", options.lights},
                    {"omni", countOf(gather::LightClass::omni)},
                    {"directional", countOf(gather::LightClass::directional)},
                    {"diffuse", countOf(gather::LightClass::diffuse)},
                    {"glossy", countOf(gather::LightClass::glossy)},
                    {"spherical", countOf(gather::LightClass::spherical)},
                    {"vsgl", countOf(gather::LightClass::gaussian)},
                    {"photons", report.photons},
                    {"particles", lights.particles},
                    {"sets", report.sets}};
  if (options.lights == "richvpl") {
    const double richLights = static_cast<double>(s.count("rich_lights"));
    json["lights"]["radiance"] = richRadianceOf(options);
    json["lights"]["rich_lights"] = s.count("rich_lights");
    json["lights"]["bytes_per_rich_light"] =
        ratio(static_cast<double>(s.count("rich_bytes")), richLights);
  }
  json["gather"] = {{"strategy", gathers ? options.gather : "none"},
                    {"mode", options.gather == "sglc" && gathers ? cutModeOf(options) : ""},
                    {"bound", pairs ? boundOf(options) : ""},
                    {"threshold", bounded ? Json(thresholdOf(options)) : Json()},
                    {"error", gathers && options.error > 0 ? Json(options.error) : Json()},
                    {"near_lights", gathers ? nearLightsOf(options) : 0.f}};
  if (const ReductionReport& r = report.reduction; r.sets > 0) {
    json["gather"]["rows"] = r.rows;
    json["gather"]["columns"] = ratio(static_cast<double>(r.columns), static_cast<double>(r.sets));
    json["gather"]["sketch"] = r.sketch;
    json["gather"]["predicted_error"] = r.error(1);
    json["gather"]["predicted_error_direct"] = r.error(0);
  }
  if (options.gather == "lightslice" && gathers) {
    json["gather"]["slices"] = slicesOf(options);
    json["gather"]["columns"] = sliceColumnsOf(options);
  }
  if (gathers && hasCutSize(options)) json["gather"]["cut_size"] = cutSizeOf(options);
  if (options.gather == "sglc" && options.error > 0 && gathers) {
    json["gather"]["clusters_missing_error"] =
        ratio(static_cast<double>(s.count("error_missed")),
              static_cast<double>(s.count("receiver_clusters")));
  }
  json["receivers"] = {{"diffuse", report.diffuseReceivers}, {"glossy", report.glossyReceivers}};
  json["seconds"] = secondsJson(s);
  json["counts"] = {{"shadow_rays", s.count("shadow_rays")},
                    {"shared_rays", s.count("shared_rays")},
                    {"path_rays", s.count("path_rays")},
                    {"rays_per_pixel", ratio(shadowRays, static_cast<double>(pixels))},
                    {"node_pairs_visited", s.count("node_pairs_visited")},
                    {"node_pairs_shaded", s.count("node_pairs_shaded")},
                    {"dominant_lights", s.count("dominant_lights")},
                    {"dominant_comparisons", s.count("dominant_comparisons")},
                    {"cut_nodes_per_pixel", ratio(static_cast<double>(s.count("cut_lights")),
                                                  static_cast<double>(pixels))},
                    {"lights_per_light_node", lightsPerNode(report, s)},
                    {"pixels_per_pixel_node", pointsPerCluster(report, s)},
                    {"specular_connections", s.count("specular_connections")},
                    {"light_points", s.count("light_points")},
                    {"near_receivers", s.count("near_receivers")},
                    {"paths_cut", s.count("paths_cut")},
                    {"nonfinite", s.count("nonfinite") + countNonFinite(film)}};
  json["memory"] = {{"peak_bytes", peakBytes()},
                    {"embree_bytes", s.value("embree_bytes")},
                    {"bytes_per_light",
                     ratio(static_cast<double>(lights.bytes), static_cast<double>(lights.total))},
                    {"bytes_per_receiver", ratio(receiverBytes, receivers)}};
  const std::string text = json.dump(2) + "\n";
  writeFileAtomically(file, std::as_bytes(std::span<const char>(text)));
}

}  // namespace lobelia::app
