// The loss of energy by clamping and by diffuse-only lights [Hasan09 sections 1 and 3; figure 1
// there]: mean of the indirect light of `vpl` and `glossy` relative to the path tracer over
// --clamp.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/app/bench_scene.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/base/random.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kPixels = 1024, kLights = 4096, kLightStream = 1;
constexpr int kSpp = 2048, kSets = 16;

struct Outcome {
  Estimate ratio;
  double l2;
};

Outcome measure(BenchScene& scene, const Reference& reference, const std::string& model,
                const std::string& clamp, uint64_t lights, int sets, Context& context) {
  std::vector<double> means;
  double l2 = 0;
  for (int i = 0; i < sets && !context.cancelled(); ++i) {
    const Film film = scene.virtualLights(model, clamp, lights, 1,
                                          hashCombine(kLightStream, static_cast<uint64_t>(i)));
    means.push_back(scene.mean(film));
    l2 += compare(film, reference.first, &reference.second).l2 / sets;
  }
  return {ratio(estimate(means), reference.mean), l2};
}

BenchTable clampCurve(const BenchOptions& options, const std::string& defaultScene,
                      const std::string& key, Context& context) {
  BenchScene scene(options, {.scene = defaultScene, .pixels = kPixels}, context);
  const uint64_t lights = options.lightCount > 0 ? options.lightCount : kLights;
  const int sets = options.sets > 0 ? options.sets : kSets;
  const Reference reference =
      pathReference(scene, options.spp > 0 ? options.spp : kSpp, options.seed, context);
  BenchTable table{
      key,
      fmt::format("Indirect light relative to path tracing, by --clamp: {}", scene.name()),
      {{"clamp", "clamp", "{:.3g}"},
       {"vpl_ratio", "vpl, mean ratio", "{:.4f}"},
       {"vpl_error", "±", "{:.4f}"},
       {"vpl_l2", "vpl, l2", "{:.3f}"},
       {"glossy_ratio", "glossy, mean ratio", "{:.4f}"},
       {"glossy_error", "±", "{:.4f}"},
       {"glossy_l2", "glossy, l2", "{:.3f}"}},
      {},
      {}};
  const std::vector<double> clamps = clampValues(scene.radius());
  for (size_t i = 0; i < clamps.size() && !context.cancelled(); ++i) {
    context.progress(fmt::format("{}{}, clamps", kBenchStage, scene.name()),
                     static_cast<double>(i) / static_cast<double>(clamps.size()));
    const bool off = !std::isfinite(clamps[i]);
    const std::string clamp = clampText(clamps[i]);
    const Outcome vpl = measure(scene, reference, "vpl", clamp, lights, sets, context);
    const Outcome glossy = measure(scene, reference, "glossy", clamp, lights, sets, context);
    if (context.cancelled()) break;
    table.rows.push_back({off ? BenchCell("off") : BenchCell(clamps[i]), vpl.ratio.mean,
                          vpl.ratio.error, vpl.l2, glossy.ratio.mean, glossy.ratio.error,
                          glossy.l2});
  }
  table.notes = {
      fmt::format("{} pixels, {} sets of {} lights, the same for every clamp; l2 is the "
                  "mean error of one set's picture. Clamp in 1/(scene unit)².",
                  scene.pixelCount(), sets, lights)};
  return table;
}

}  // namespace

std::vector<BenchTable> benchClamp(const BenchOptions& options, Context& context) {
  if (!options.scene.scene.empty()) return {clampCurve(options, "", "clamp", context)};
  std::vector<BenchTable> tables{clampCurve(options, "study-phong", "phong", context)};
  if (!context.cancelled()) tables.push_back(clampCurve(options, "study-ggx", "ggx", context));
  return tables;
}

}  // namespace lobelia::app
