#include "lobelia/app/view_statistics.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <span>

#include "lobelia/base/file.h"
#include "lobelia/relight/light_cut.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

double frameSeconds(const Statistics& s) {
  double sum = 0;
  for (const char* stage : {"light", "buffer", "cut", "merge", "direct", "shade"})
    sum += s.seconds(stage);
  return sum;
}

Json countsJson(const Statistics& s, bool cuts) {
  const auto count = [&](const char* name) { return static_cast<double>(s.count(name)); };
  const double frames = count("frames"), pixels = count("object_pixels");
  Json json{{"frames", s.count("frames")},
            {"pixels", s.count("pixels")},
            {"object_pixels", s.count("object_pixels")},
            {"vertices_per_frame", ratio(count("vertices_merged"), frames)},
            {"light_lookups_per_pixel", ratio(count("light_lookups"), pixels)},
            {"shadow_rays", s.count("shadow_rays") + s.count("light_rays")},
            {"cut_nodes_per_pixel", ratio(count("cut_nodes"), pixels)},
            {"nonfinite", s.count("nonfinite")}};
  if (cuts)
    json.update(
        {{"merged_nodes_per_vertex", ratio(count("merged_nodes"), count("vertices_merged"))},
         {"evaluations_per_pixel", ratio(count("evaluations"), pixels)},
         {"fine_nodes_per_pixel",
          ratio(count("fine_chunks") * static_cast<double>(relight::kChunk), pixels)},
         {"light_rays_per_frame", ratio(count("light_rays"), frames)},
         {"mirror_rays", s.count("mirror_rays")}});
  return json;
}

// Of what the cuts are, in the data and in frames.
Json cutsJson(const ViewOptions& options, const relight::VisibilityData& data) {
  const auto vertices = static_cast<double>(data.cuts.count());
  return {{"light_cut", options.lightCut},
          {"vertices", data.cuts.count()},
          {"visibility_cut", ratio(static_cast<double>(data.cuts.nodes().size()), vertices)}};
}

Json transferJson(const transfer::TransferData& data) {
  return {{"directions", transfer::GeodesicGrid(data.directionLevel).count()},
          {"passes", data.passes.size()},
          {"classes", data.classCount},
          {"vertices", data.mesh.vertices.size()},
          {"records", data.recordCount()},
          {"bytes", data.byteCount()}};
}

}  // namespace

double framesPerSecond(const Statistics& statistics) {
  return ratio(static_cast<double>(statistics.count("frames")), frameSeconds(statistics));
}

void writeViewStatistics(const ViewOptions& options, const Scene& scene, const ViewData& all,
                         const Context& context) {
  const CutData& both = all.cuts;
  const relight::VisibilityData* const data = both.any();
  const Statistics& s = context.statistics;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  Json json;
  json["version"] = kVersion;
  json["scene"] = {{"triangles", triangleCount(scene)},
                   {"materials", scene.materials.size()},
                   {"emitters", scene.emitters.size()}};
  json["lights"] = {{"model", both.environment && both.surfaces ? "environment and surfaces"
                              : both.surfaces                   ? "surfaces"
                                                                : "environment"}};
  if (data != nullptr) json["lights"]["samples"] = data->samples.count();
  for (const char* kind : {"omni", "directional", "diffuse", "glossy", "spherical", "vsgl"})
    json["lights"][kind] = 0;
  json["gather"] = {{"strategy", viewMethodNames()[static_cast<size_t>(all.method)]},
                    {"mode", data == nullptr      ? ""
                             : options.plainLobes ? "plain"
                                                  : "refined"},
                    {"bound", ""},
                    {"threshold", nullptr},
                    {"error", nullptr}};
  if (data != nullptr) json["gather"].update(cutsJson(options, *data));
  if (all.transfer) json["transfer"] = transferJson(*all.transfer);
  json["receivers"] = {{"diffuse", 0}, {"glossy", 0}};
  if (data != nullptr)
    for (const char* stage : {"cut", "direct"}) json["seconds"][stage] = s.seconds(stage);
  for (const char* stage : {"load", "accel", "data", "prepare", "light", "buffer", "merge", "shade",
                            "total", "receivers", "lights", "trees", "traverse", "visibility"})
    json["seconds"][stage] = s.seconds(stage);
  json["counts"] = countsJson(s, data != nullptr);
  for (const char* count :
       {"rays_per_pixel", "node_pairs_visited", "node_pairs_shaded", "lights_per_light_node",
        "pixels_per_pixel_node", "specular_connections"})
    json["counts"][count] = 0;
  json["frames_per_second"] = framesPerSecond(s);
  json["memory"] = {{"peak_bytes", static_cast<uint64_t>(usage.ru_maxrss) * 1024},
                    {"embree_bytes", s.value("embree_bytes")},
                    {"bytes_per_light", 0},
                    {"bytes_per_receiver", 0}};
  const std::string text = json.dump(2) + "\n";
  writeFileAtomically(options.render.stats, std::as_bytes(std::span<const char>(text)));
}

}  // namespace lobelia::app
