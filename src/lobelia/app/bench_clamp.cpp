// The loss of energy by clamping and by diffuse-only lights [P003 sections 1 and 3; figure 1
// there]: mean of the indirect light of `vpl` and `glossy` relative to the path tracer over
// --clamp.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "lobelia/app/bench_scene.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/base/random.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kPixels = 1024, kLights = 4096, kLightStream = 1;
constexpr int kSpp = 2048, kSets = 16;

// Powers of ten around 1 / radius^2, the unit of what is clamped, and none at all.
std::vector<double> clampValues(float radius) {
  const double middle = std::round(-2 * std::log10(static_cast<double>(std::max(radius, 1e-6f))));
  std::vector<double> values;
  for (int i = -2; i <= 4; ++i) values.push_back(std::pow(10, middle + i));
  values.push_back(std::numeric_limits<double>::infinity());
  return values;
}

struct Outcome {
  Estimate ratio;
  double l2;
};

Outcome measure(BenchScene& scene, const Reference& reference, const std::string& model,
                const std::string& clamp, uint64_t lights, int sets, Context& context) {
  std::vector<double> means;
  double l2 = 0;
  for (int i = 0; i < sets && !context.cancelled(); ++i) {
    const Film film = scene.virtualLights(model, clamp, lights,
                                          hashCombine(kLightStream, static_cast<uint64_t>(i)));
    means.push_back(scene.mean(film));
    l2 += compare(film, reference.first, &reference.second).l2 / sets;
  }
  return {ratio(estimate(means), reference.mean), l2};
}

}  // namespace

std::vector<BenchTable> benchClamp(const BenchOptions& options, Context& context) {
  BenchScene scene(options, "study-ggx", kPixels, context);
  const uint64_t lights = options.lightCount > 0 ? options.lightCount : kLights;
  const int sets = options.sets > 0 ? options.sets : kSets;
  const Reference reference =
      pathReference(scene, options.spp > 0 ? options.spp : kSpp, options.seed, context);
  BenchTable table{
      "clamp",
      fmt::format("Indirect light relative to path tracing, by --clamp: {}", scene.name()),
      {{"clamp", "clamp", "{:g}"},
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
    context.progress(fmt::format("{}clamp", kBenchStage),
                     static_cast<double>(i) / static_cast<double>(clamps.size()));
    const bool off = !std::isfinite(clamps[i]);
    const std::string clamp = off ? "off" : fmt::format("{:g}", clamps[i]);
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
  return {table};
}

}  // namespace lobelia::app
