#include "lobelia/app/bench_cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "lobelia/app/bench_cuts_vertices.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/app/load_scene.h"

namespace lobelia::app {
namespace {

const std::vector<std::string> kScenes = {"statue", "machine", "plants"};
const std::vector<std::string> kLocalScenes = {"dining", "teapot-lamp", "bedroom"};
constexpr int kDirectLight = 2;  // --max-depth
constexpr size_t kVertices = 1024;

// Figures 5 and 8, which look at the same vertices.
void compareTrees(const std::string& name, bool figure5, bool figure8, const CutsStudy& study) {
  const BenchOptions options = study.optionsOf(name);
  const Scene scene = loadScene(options.scene, study.context);
  const Tracer tracer(scene, study.context);
  study.context.seed = options.seed;
  const size_t count = options.pixels > 0 ? options.pixels : kVertices;
  const StudyVertices vertices(tracer, count, study.context);
  cutsClusters(name, tracer, vertices, figure5, figure8, study);
  if (figure8) cutsWavelets(name, vertices, study);
}

}  // namespace

void CutsStudy::progress(const std::string& scene, const std::string& what) const {
  context.progress(fmt::format("{}{}, {}", kBenchStage, scene, what), 0.5);
}

BenchOptions CutsStudy::optionsOf(const std::string& scene) const {
  BenchOptions out = options;
  out.scene.scene = scene;
  if (out.maxDepth == 0) out.maxDepth = kDirectLight;
  return out;
}

size_t CutsStudy::sampleCount() const {
  constexpr uint64_t kMost = 32768;
  if (options.lightCount == 0) return kMost;
  if (!std::has_single_bit(options.lightCount) || options.lightCount > kMost)
    throw UsageError(fmt::format("bench cuts: --num-lights {} directions: a power of two up to {}",
                                 options.lightCount, kMost));
  return options.lightCount;
}

Film emptyFrame(const Camera& camera) {
  Film film = makeFilm(camera, {});
  film.layers.erase("direct");
  film.layers.erase("indirect");
  return film;
}

Camera timedCamera(const Scene& scene, const BenchOptions& options) {
  RenderOptions render;
  render.size = options.size.empty() ? "640x480" : options.size;
  render.camera = options.camera;
  return chooseCamera(scene, render);
}

void changeRoughness(std::vector<Material>& materials, int i) {
  const float rougher = 1 + 0.2f * static_cast<float>(std::sin(i));
  for (Material& m : materials)
    for (FloatParam* alpha : {&m.alphaU, &m.alphaV, &m.roughness})
      if (m.type != MaterialType::phong) alpha->value = std::min(alpha->value * rougher, 1.f);
}

const std::vector<std::string>& cutsFigures() {
  static const std::vector<std::string> figures{"5", "6", "7", "8", "9", "9-local", "10", "sigma"};
  return figures;
}

std::vector<BenchTable> benchCuts(const BenchOptions& options, Context& context) {
  const std::set<std::string> figures = chosenOf("--figures", options.figures, cutsFigures());
  FigureReport report(options.output, "cuts", "Visibility cuts");
  const CutsStudy study{options, report, context};
  for (const std::string& scene : options.scenes.empty() ? kScenes : options.scenes) {
    try {
      const bool clusters = figures.contains("5"), wavelets = figures.contains("8");
      if ((clusters || wavelets) && !context.cancelled())
        compareTrees(scene, clusters, wavelets, study);
      if (figures.contains("6") && !context.cancelled()) cutsMaterials(scene, study);
      if (figures.contains("9") && !context.cancelled()) cutsData(scene, study);
      const bool lightCuts = figures.contains("10"), sigmas = figures.contains("sigma");
      if ((lightCuts || sigmas) && !context.cancelled()) cutsError(scene, lightCuts, sigmas, study);
    } catch (const Cancelled&) {  // the tables have what there is
    }
    report.writePage(options.commandLine);
  }
  if ((figures.contains("7") || figures.contains("9-local")) && !context.cancelled()) {
    for (const std::string& scene : options.scenes.empty() ? kLocalScenes : options.scenes) {
      try {
        if (figures.contains("7") && !context.cancelled()) cutsBounce(scene, study);
        if (figures.contains("9-local") && !context.cancelled()) cutsLocalData(scene, study);
      } catch (const Cancelled&) {  // the table has what there is
      }
    }
    report.writePage(options.commandLine);
  }
  return report.takeTables();
}

}  // namespace lobelia::app
