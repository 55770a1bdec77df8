// Figure 10 of [P004]: frames against the path tracer by the size of the light cut, and with all of
// the light.
#include <fmt/format.h>

#include "lobelia/app/bench_cuts.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kReferenceSeed = 42;
constexpr int kReferenceSamples = 1024, kFrameSamples = 16;
constexpr size_t kLightCuts[] = {64, 128, 256, 512, 1024, 32768};

// 1 where the middle of a pixel and those of its neighbours see a surface: edges against the
// background are no error of the method.
Film objectsOf(const Tracer& tracer, const Camera& camera) {
  Film mask = emptyFrame(camera);
  const int width = camera.width, height = camera.height;
  std::vector<uint8_t> seen(static_cast<size_t>(width) * static_cast<size_t>(height));
  const auto at = [&](int x, int y) -> uint8_t& {
    return seen[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec2f place{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
      at(x, y) = tracer.intersect(generateRay(camera, place, {0.5f, 0.5f})) ? 1 : 0;
    }
  std::vector<float>& values = mask.layers.at("").values;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      bool inside = true;
      for (int k = 0; k < 9; ++k) inside = inside && at(x + k % 3 - 1, y + k / 3 - 1) != 0;
      const size_t pixel =
          static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      for (size_t c = 0; c < 3; ++c) values[3 * pixel + c] = inside ? 1.f : 0.f;
    }
  return mask;
}

}  // namespace

void cutsError(const std::string& name, const CutsStudy& study) {
  BenchOptions options = study.optionsOf(name);
  if (options.size.empty()) options.size = "320x240";
  BenchScene scene(options, {.scene = name, .component = "all"}, study.context);
  const Reference path = pathReference(scene, options.spp > 0 ? options.spp : kReferenceSamples,
                                       kReferenceSeed, study.context);
  if (study.cancelled()) return;
  study.context.seed = options.seed;
  study.progress(name, "precomputation");
  relight::PrecomputeSettings settings;
  settings.sampleCount = study.sampleCount();
  const relight::VisibilityData data =
      relight::precomputeVisibility(scene.tracer(), settings, study.context);
  relight::FrameRenderer renderer(scene.tracer(), scene.emitters(), data);
  const Film objects = objectsOf(scene.tracer(), scene.camera());
  BenchTable& table = study.report.table(
      {"figure10",
       "Figure 10: error by the size of the light cut",
       {{"scene", "scene"},
        {"nodes", "light cut", "{:.0f}"},
        {"lobes", "narrow lobes"},
        {"l2", "l2", "{:.4f}"},
        {"mean_ratio", "mean ratio", "{:.4f}"}},
       {},
       {fmt::format("Light from infinity that arrives straight, {}x{}, {} samples of a pixel's "
                    "filter, pixels whose neighbours all see a surface. Path tracing: {} samples "
                    "in two halves. Narrow lobes: with finer light where they look (refined), or "
                    "by the light cut alone (plain, the paper's).",
                    scene.camera().width, scene.camera().height, kFrameSamples,
                    options.spp > 0 ? options.spp : kReferenceSamples)}});
  const ToneCurve curve = measureToneCurve(path.first, {});
  std::vector<FigurePicture> line{
      {"path tracer",
       study.report.picture(fmt::format("figure10-{}-path", name), path.first, curve)}};
  for (const size_t nodes : kLightCuts)
    for (const bool refined : {true, false}) {
      if (study.cancelled() || nodes > data.samples.count()) continue;
      study.progress(name, fmt::format("light cut of {}", nodes));
      Film film = emptyFrame(scene.camera());
      const relight::FrameLight light = renderer.light(0, {.nodeCount = nodes}, study.context);
      renderer.render(light, scene.camera(),
                      {.spp = kFrameSamples,
                       .refined = refined,
                       .hideEmitters = scene.tracer().scene().hideEmitters},
                      film, study.context);
      const Comparison error = compare(film, path.first, &path.second, &objects);
      table.rows.push_back({name, static_cast<double>(nodes),
                            std::string(refined ? "refined" : "plain"), error.l2, error.meanRatio});
      if (refined && (nodes == 64 || nodes == 512))
        line.push_back(
            {fmt::format("{} nodes", nodes),
             study.report.picture(fmt::format("figure10-{}-{}", name, nodes), film, curve)});
    }
  study.report.show("figure10", name, line);
}

}  // namespace lobelia::app
