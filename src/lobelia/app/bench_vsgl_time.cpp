// Time of pictures with virtual spherical Gaussian lights, by kinds of shadows; and how many lights
// cuts of their tree take, against cuts over point lights.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "lobelia/app/bench_vsgl.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kTimeLights = 1024;
constexpr uint64_t kCutPixels = 2000, kCutPoints = 200'000;
constexpr int kCutSamples = 16;
constexpr size_t kCutSizes[] = {16, 32, 64, 128, 256, 512, 1024};
constexpr size_t kPointsOfLight[] = {4, 16};

BenchOptions optionsOf(const std::string& scene, const VsglStudy& study) {
  BenchOptions options = study.options;
  options.scene.scene = scene;
  return options;
}

}  // namespace

void vsglTime(const std::string& name, const VsglStudy& study) {
  BenchOptions options = optionsOf(name, study);
  if (options.size.empty()) options.size = "960x540";
  BenchScene scene(options, {.scene = name}, study.context);
  BenchTable& table =
      study.report.table({"time",
                          "Time of a picture",
                          {{"scene", "scene"},
                           {"lights", "lights", "{:.0f}"},
                           {"shadows", "shadows"},
                           {"receivers", "receivers, s", "{:.2f}"},
                           {"light_pass", "lights, s", "{:.2f}"},
                           {"visibility", "rays, s", "{:.2f}"},
                           {"shade", "shading, s", "{:.2f}"},
                           {"mrays", "million rays", "{:.1f}"},
                           {"l2", "l2, a ray to every light", "{:.3f}"},
                           {"mean_ratio", "mean ratio", "{:.4f}"}},
                          {},
                          {fmt::format("Indirect light, {}x{}, one eye sample.",
                                       scene.camera().width, scene.camera().height)}});
  std::optional<Film> first;
  const uint64_t lights = options.lightCount > 0 ? options.lightCount : kTimeLights;
  const auto add = [&](uint64_t count, const std::string& shadows, bool compared) {
    if (study.cancelled()) return;
    study.progress(scene, fmt::format("{} lights, shadows {}", count, shadows));
    const Spent spent(study.context);
    const Film film = scene.virtualLights(
        [&](RenderOptions& render) {
          render.lights = "vsgl";
          render.spp = 1;
          render.lightCount = count;
          render.vsglShadows = shadows;
        },
        kVsglSeed, BenchScene::Extent::picture);
    if (study.cancelled()) return;
    if (!first) first = film;
    const Comparison error = compared ? compare(film, *first) : Comparison{};
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    table.rows.push_back({scene.name(), static_cast<double>(count), shadows,
                          spent.seconds("receivers"), spent.seconds("lights"),
                          spent.seconds("visibility"), spent.seconds("shade"),
                          1e-6 * spent.count("shadow_rays"), compared ? error.l2 : kNone,
                          compared ? error.meanRatio : kNone});
  };
  add(lights, "mean", true);
  for (const char* shadows : {"random", "maps", "4", "16", "64", "none"})
    add(lights, shadows, true);
  add(2, "none", false);
}

namespace {

struct CutRun {
  std::string label, model;
  uint64_t lights = 0, points = 0;
};

}  // namespace

void vsglCuts(const std::string& name, const VsglStudy& study) {
  BenchScene scene(optionsOf(name, study), {.scene = name, .pixels = kCutPixels, .width = 400},
                   study.context);
  const Reference path = pathReference(scene, study.pathSamples, kVsglReferenceSeed, study.context);
  BenchTable& table = study.report.table(
      {"cuts",
       "Lights that a receiver gathers: point lights and VSGLs",
       {{"scene", "scene"},
        {"model", "lights"},
        {"count", "in the tree", "{:.0f}"},
        {"cut", "cut", "{:.0f}"},
        {"gathered", "lights per receiver", "{:.1f}"},
        {"rays", "rays per pixel", "{:.1f}"},
        {"seconds", "s", "{:.2f}"},
        {"l2", "l2, path tracer", "{:.3f}"},
        {"mean_ratio", "mean ratio", "{:.4f}"}},
       {},
       {fmt::format(
           "sglc, mode unbiased, {} pixels of a picture of {}x{}, one set of lights, {} "
           "eye samples, no clamp; VSGLs are clusters of as many points as there are point "
           "lights. Path tracing: two halves of {} samples.",
           scene.pixelCount(), scene.camera().width, scene.camera().height, kCutSamples,
           study.pathSamples / 2)}});
  const uint64_t points = study.options.lightCount > 0 ? study.options.lightCount : kCutPoints;
  std::vector<CutRun> runs{{"points", "glossy", points, 0}};
  for (const size_t share : kPointsOfLight)
    runs.push_back({fmt::format("VSGLs of {}", share), "vsgl", points / share, points});
  for (const CutRun& run : runs) {
    for (const size_t cut : kCutSizes) {
      if (study.cancelled()) return;
      study.progress(scene, fmt::format("{}, cuts of {}", run.label, cut));
      const Spent spent(study.context);
      const auto change = [&](RenderOptions& options) {
        options.lights = run.model;
        options.gather = "sglc";
        options.cutMode = "unbiased";
        options.cutSize = cut;
        options.spp = kCutSamples;
        options.lightCount = run.lights;
        options.vsglPoints = run.points;
      };
      const Film film = scene.virtualLights(change, kVsglSeed);
      if (study.cancelled()) return;
      const Comparison error = compare(film, path.first, &path.second);
      table.rows.push_back({scene.name(), run.label, static_cast<double>(run.lights),
                            static_cast<double>(cut),
                            spent.count("cut_lights") / spent.count("receiver_clusters"),
                            spent.count("shadow_rays") / static_cast<double>(scene.pixelCount()),
                            spent.total(), error.l2, error.meanRatio});
    }
  }
}

}  // namespace lobelia::app
