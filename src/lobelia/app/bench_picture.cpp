// Time and error of whole pictures: glossy virtual lights in growing sets, and the path tracer
// beside them, against two independent references (`compare --reference2`).
#include <fmt/format.h>

#include <cmath>

#include "lobelia/app/bench_scene.h"
#include "lobelia/app/bench_spent.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kLights = 2048, kSeed = 3, kReferenceSeed = 4;
constexpr int kWidth = 256, kSpp = 1024, kEyeSamples = 4;

}  // namespace

std::vector<BenchTable> benchPicture(const BenchOptions& options, Context& context) {
  BenchScene scene(options, {.scene = "cornell", .width = kWidth, .component = "all"}, context);
  const int spp = options.spp > 0 ? options.spp : kSpp;
  const Reference reference = pathReference(scene, spp, kReferenceSeed, context);
  BenchTable table{
      "picture",
      fmt::format("Whole pictures: {}, {}x{}", scene.name(), scene.camera().width,
                  scene.camera().height),
      {{"method", "method"},
       {"lights", "lights", "{:.0f}"},
       {"spp", "spp", "{:.0f}"},
       {"seconds", "seconds", "{:.2f}"},
       {"receivers", "receivers", "{:.2f}"},
       {"light_pass", "light pass", "{:.2f}"},
       {"visibility", "visibility", "{:.2f}"},
       {"shade", "shade", "{:.2f}"},
       {"mrays", "million rays", "{:.1f}"},
       {"mrays_per_second", "million rays/s", "{:.1f}"},
       {"l2", "l2", "{:.3f}"},
       {"mean_ratio", "mean ratio", "{:.4f}"}},
      {},
      {fmt::format("All light; reference: path tracing, two halves of {} samples per pixel; the "
                   "acceleration structure took {:.2f} s.",
                   spp / 2, context.statistics.seconds("accel"))}};
  const auto addRow = [&](const std::string& method, double lights, int samples,
                          const auto& picture) {
    if (context.cancelled()) return;
    const Spent spent(context);
    const Film film = picture();
    const double seconds = spent.total(),
                 rays = spent.count("shadow_rays") + spent.count("path_rays");
    if (context.cancelled()) return;
    const Comparison error = compare(film, reference.first, &reference.second);
    table.rows.push_back({method, lights, static_cast<double>(samples), seconds,
                          spent.seconds("receivers"), spent.seconds("lights"),
                          spent.seconds("visibility"), spent.seconds("shade"), 1e-6 * rays,
                          1e-6 * rays / seconds, error.l2, error.meanRatio});
  };
  const uint64_t middle = options.lightCount > 0 ? options.lightCount : kLights;
  for (const uint64_t lights : {std::max<uint64_t>(1, middle / 4), middle, 4 * middle}) {
    context.progress(fmt::format("{}pictures", kBenchStage), 0.2);
    addRow("glossy", static_cast<double>(lights), kEyeSamples,
           [&] { return scene.virtualLights("glossy", "off", lights, kEyeSamples, kSeed); });
  }
  for (const int samples : {std::max(1, spp / 64), std::max(1, spp / 16)})
    addRow("path", std::nan(""), samples, [&] { return scene.pathTraced(samples, kSeed); });
  return {table};
}

}  // namespace lobelia::app
