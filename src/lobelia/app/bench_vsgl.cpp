#include "lobelia/app/bench_vsgl.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/app/bench_studies.h"

namespace lobelia::app {
namespace {

const std::vector<std::string> kScenes = {"box", "kitchen", "treasure"};

}  // namespace

std::string VsglStudy::stem(const BenchScene& scene) const {
  std::string stem = scene.name();
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return c == '/' || c == '\\'; }, '-');
  return stem;
}

void VsglStudy::progress(const BenchScene& scene, const std::string& what) const {
  context.progress(fmt::format("{}{}, {}", kBenchStage, scene.name(), what), 0.5);
}

const std::vector<std::string>& vsglFigures() {
  static const std::vector<std::string> figures{"sampling", "time", "cuts"};
  return figures;
}

std::vector<BenchTable> benchVsgl(const BenchOptions& options, Context& context) {
  const std::set<std::string> figures = chosenOf("--figures", options.figures, vsglFigures());
  FigureReport report(options.output, "vsgl", "Virtual spherical Gaussian lights");
  VsglStudy study{options, report, context};
  if (options.spp > 0) study.pathSamples = options.spp;
  for (const std::string& scene : options.scenes.empty() ? kScenes : options.scenes) {
    if (figures.contains("sampling") && !context.cancelled()) vsglSampling(scene, study);
    if (figures.contains("time") && !context.cancelled()) vsglTime(scene, study);
    if (figures.contains("cuts") && !context.cancelled()) vsglCuts(scene, study);
    report.writePage(options.commandLine);
  }
  return report.takeTables();
}

}  // namespace lobelia::app
