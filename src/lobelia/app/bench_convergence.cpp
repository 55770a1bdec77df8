// Do glossy virtual lights, all gathered and never clamped, bring the light that the path tracer
// finds? Mean of the indirect light relative to it, with standard errors, over growing sets of
// lights. Every picture has one eye sample per pixel: where light comes over specular connections
// their noise is that of the number of sets, whatever the size of a set.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/app/bench_scene.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/base/random.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kPixels = 512, kLights = 4096, kLightStream = 2;
constexpr int kSpp = 4096, kSets = 128, kL2Sets = 8;

struct StudyScene {
  const char* name;
  double target;  // greatest deviation of the mean that is asked for
};
constexpr StudyScene kScenes[] = {{"study-diffuse", 0.01},
                                  {"study-phong", 0.01},
                                  {"study-ggx", 0.03},
                                  {"study-pane", 0.02},
                                  {"study-mirror", 0.02}};

void addScene(const BenchOptions& options, const StudyScene& study, BenchTable* table,
              Context& context) {
  BenchScene scene(options, {.scene = study.name, .pixels = kPixels}, context);
  const Reference reference =
      pathReference(scene, options.spp > 0 ? options.spp : kSpp, options.seed, context);
  const uint64_t most = options.lightCount > 0 ? options.lightCount : kLights;
  const int sets = options.sets > 0 ? options.sets : kSets;
  for (const uint64_t part : {16u, 4u, 1u}) {
    const uint64_t lights = std::max<uint64_t>(1, most / part);
    std::vector<double> means;
    double l2 = 0;
    const int l2Sets = std::min(sets, kL2Sets);
    for (int i = 0; i < sets && !context.cancelled(); ++i) {
      context.progress(fmt::format("{}{}, {} lights", kBenchStage, scene.name(), lights),
                       static_cast<double>(i) / sets);
      const uint64_t seed = hashCombine(hashCombine(kLightStream, part), static_cast<uint64_t>(i));
      const Film film = scene.virtualLights("glossy", "off", lights, 1, seed);
      means.push_back(scene.mean(film));
      if (i < l2Sets) l2 += compare(film, reference.first, &reference.second).l2 / l2Sets;
    }
    if (context.cancelled()) return;
    const Estimate r = ratio(estimate(means), reference.mean);
    table->rows.push_back(
        {scene.name(), static_cast<double>(lights), static_cast<double>(sets), r.mean, r.error,
         100 * reference.mean.error / reference.mean.mean, l2, study.target,
         std::isfinite(study.target) ? (std::abs(r.mean - 1) <= study.target ? "yes" : "no") : ""});
  }
}

}  // namespace

std::vector<BenchTable> benchConvergence(const BenchOptions& options, Context& context) {
  BenchTable table{"convergence",
                   "Mean indirect light of glossy virtual lights relative to path tracing",
                   {{"scene", "scene"},
                    {"lights", "lights", "{:.0f}"},
                    {"sets", "sets", "{:.0f}"},
                    {"mean_ratio", "mean ratio", "{:.4f}"},
                    {"error", "±", "{:.4f}"},
                    {"reference_error_percent", "of it the reference, %", "{:.2f}"},
                    {"l2", "l2 of one set", "{:.3f}"},
                    {"target", "target", "{:.2f}"},
                    {"within", "within"}},
                   {},
                   {"--gather all --clamp off; ± is the standard error of the ratio."}};
  if (!options.scene.scene.empty()) {
    addScene(options, {"", std::nan("")}, &table, context);
  } else {
    for (const StudyScene& study : kScenes) {
      if (context.cancelled()) break;
      addScene(options, study, &table, context);
    }
  }
  return {table};
}

}  // namespace lobelia::app
