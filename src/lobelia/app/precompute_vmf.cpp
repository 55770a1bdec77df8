// `lobelia precompute --method vmf`.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lobelia/app/load_scene.h"
#include "lobelia/app/precompute_methods.h"
#include "lobelia/app/precompute_report.h"
#include "lobelia/app/transfer_frames.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/adaptive_mesh.h"
#include "lobelia/transfer/memory_budget.h"
#include "lobelia/transfer/scatter.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;
using transfer::TransferData;
using transfer::TransferSettings;

TransferSettings settingsOf(const PrecomputeOptions& options, const Scene& scene) {
  TransferSettings settings = options.vmf;
  settings.directionLevel = directionLevel(options);
  settings.rayLevel = options.rays == "auto" ? 0 : std::stoi(options.rays);
  settings.subdivision = options.subdivision;
  if (options.lobes == "materials")
    settings.classCount =
        std::clamp(static_cast<int>(scene.materials.size()), 1, transfer::kMostClasses);
  settings.workFolder = workFolder(options);
  return settings;
}

// How full rows of slices are: records over the slices that there could be.
double density(const std::vector<transfer::SliceRows>& lobes, size_t vertices, double directions) {
  size_t records = 0;
  for (const transfer::SliceRows& rows : lobes) records += rows.recordCount();
  const double most = static_cast<double>(lobes.size() * vertices) * directions;
  return ratio(static_cast<double>(records), most);
}

Json transferJson(const PrecomputeOptions& options, const TransferData& data) {
  const double directions = std::stod(options.directions);
  const size_t vertices = data.mesh.vertices.size();
  size_t lobes = 0;
  Json byPass = Json::array();
  for (const transfer::TransferPass& pass : data.passes) {
    lobes += pass.glossy.size();
    byPass.push_back(density(pass.glossy, vertices, directions));
  }
  const auto records = static_cast<double>(data.recordCount());
  return {{"directions", std::stoi(options.directions)},
          {"passes", data.passes.size()},
          {"classes", data.classCount},
          {"vertices", vertices},
          {"lobes", lobes},
          {"records", data.recordCount()},
          {"bytes", data.byteCount()},
          {"density", ratio(records, static_cast<double>(vertices * lobes) * directions)},
          {"density_by_pass", std::move(byPass)}};
}

Json statisticsJson(const PrecomputeOptions& options, const TransferSettings& settings,
                    const Scene& scene, const TransferData& data, const Context& context) {
  const Statistics& s = context.statistics;
  Json json = contractStatistics(options, scene, context);
  json["lights"]["model"] = "environment";
  const bool scatters = options.solver == "scatter";
  json["precompute"].update(
      {{"solver", options.solver},
       {"directions", std::stoi(options.directions)},
       {"bounces", settings.bounces},
       {"lobes", options.lobes},
       {"rays", scatters ? "" : options.rays},
       {"mask_level", settings.maskLevel},
       {"mask_tolerance", std::stod(fmt::format("{}", settings.maskTolerance))},
       {"max_vertices", settings.mostVertices},
       {"subdivide", settings.subdivision},
       {"memory", scatters ? 0 : transfer::MemoryBudget(settings.memoryBytes).bytes()},
       {"slice_rays", scatters ? options.sliceRays : 0}});
  json["transfer"] = transferJson(options, data);
  for (const char* stage : {"masks", "trace", "direct", "bounce", "scatter"})
    json["seconds"][stage] = s.seconds(stage);
  Json& counts = json["counts"];
  for (const char* name :
       {"vertices", "vertices_added", "mask_rays", "transfer_rays", "hits", "slices",
        "slices_unoccluded", "records", "blocks", "blocks_resumed", "nonfinite"})
    counts[name] = s.count(name);
  counts["shadow_rays"] = s.count("mask_rays") + s.count("transfer_rays");
  json["rays_per_second"] = ratio(static_cast<double>(s.count("transfer_rays")),
                                  s.seconds(scatters ? "scatter" : "trace"));
  json["memory"]["data_bytes"] = data.byteCount();
  return json;
}

// Of runs that went on where one before had stopped.
std::string resumed(const Statistics& s) {
  if (s.count("blocks_resumed") == 0) return {};
  return fmt::format(" of this run, which resumed {} of {} blocks", s.count("blocks_resumed"),
                     s.count("blocks"));
}

std::string summary(const PrecomputeOptions& options, const TransferData& data,
                    const Context& context) {
  const Statistics& s = context.statistics;
  const double masks = s.seconds("masks");
  return fmt::format(
      "{} vertices ({} of them added), {} passes, {:.4g} million records, {:.1f} MB in memory; "
      "{:.4g} million rays{}; {:.1f} MB in {:.1f} s, {:.1f} s of them for masks",
      data.mesh.vertices.size(), s.count("vertices_added"), data.passes.size(),
      static_cast<double>(data.recordCount()) * 1e-6, static_cast<double>(data.byteCount()) * 1e-6,
      static_cast<double>(s.count("transfer_rays")) * 1e-6, resumed(s),
      static_cast<double>(outputBytes(options)) * 1e-6, s.seconds("total"), masks);
}

// By the baseline, on the same mesh.
TransferData scattered(const Tracer& tracer, const TransferSettings& settings, int sliceRays,
                       Context& context) {
  transfer::TransferMesh mesh;
  {
    const StageTimer timer(context, "masks");
    mesh.mesh = transfer::adaptiveMesh(tracer, settings, context);
    mesh.vertices = transfer::transferVertices(tracer.scene(), mesh.mesh);
  }
  context.statistics.addCount("vertices", mesh.vertices.size());
  TransferData data =
      transfer::scatterTransfer(tracer, std::move(mesh), settings, sliceRays, context);
  settings.keep(data);
  return data;
}

}  // namespace

std::string workFolder(const PrecomputeOptions& options) {
  if (options.work == "none" || options.solver == "scatter") return {};
  return options.work.empty() ? options.output + ".work" : options.work;
}

void precomputeVmf(const PrecomputeOptions& options, Context& context) {
  const int64_t start = nanosecondsNow();
  const Scene scene = loadScene(options.scene, context);
  warnOfMissing(scene, context);
  const Tracer tracer(scene, context);
  TransferSettings settings = settingsOf(options, scene);
  settings.keep = [&](const TransferData& data) {
    const StageTimer timer(context, "save");
    transfer::save(data, scene, options.output);
  };
  const TransferData data = options.solver == "scatter"
                                ? scattered(tracer, settings, options.sliceRays, context)
                                : transfer::precomputeTransfer(tracer, settings, context);
  context.statistics.addSeconds("total", static_cast<double>(nanosecondsNow() - start) * 1e-9);
  context.info(summary(options, data, context));
  if (const uint64_t bad = context.statistics.count("nonfinite"); bad > 0)
    context.warning(fmt::format("{} values are not finite; they are left out", bad));
  writeStatistics(options, statisticsJson(options, settings, scene, data, context));
}

}  // namespace lobelia::app
