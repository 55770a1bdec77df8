// Figures of [Hasan09] with one command: the study's options, its scenes and which figures they
// have (bench_vsl.h says where the rest is).
#include "lobelia/app/bench_vsl.h"

#include "lobelia/app/bench_studies.h"

namespace lobelia::app {
namespace {

const std::vector<std::string> kScenes = {"kitchen-stove", "hall", "tableau-ward"};

VslSettings settingsOf(const BenchOptions& options) {
  VslSettings s;
  s.figures = chosenOf("--figures", options.figures, vslFigures());
  s.folder = options.output;
  if (options.lightCount > 0) s.lights = options.lightCount;
  if (options.columns > 0) s.columns = options.columns;
  s.rows = options.rows;
  if (options.spp > 0) s.pathSamples = options.spp;
  return s;
}

}  // namespace

const std::vector<std::string>& vslFigures() {
  static const std::vector<std::string> figures{"1", "2", "4", "5", "6", "7", "8"};
  return figures;
}

std::vector<BenchTable> benchVsl(const BenchOptions& options, Context& context) {
  const VslSettings settings = settingsOf(options);
  FigureReport report(settings.folder, "vsl", "Virtual spherical lights: figures of [Hasan09]");
  const auto page = [&] { report.writePage(options.commandLine); };
  const bool ofScenes =
      settings.has(1) || settings.has(2) || settings.has(6) || settings.has(7) || settings.has(8);
  if (ofScenes) {
    for (const std::string& name : options.scenes.empty() ? kScenes : options.scenes) {
      if (context.cancelled()) break;
      VslScene scene(options, settings, name, context);
      vslMethodFigures(scene, report, context);
      if (settings.has(8)) vslCurves(scene, report, context);
      page();
    }
  }
  if (settings.has(4) && !context.cancelled()) vslCorners(options, settings, report, context);
  if (settings.has(5) && !context.cancelled()) vslSampling(options, settings, report, context);
  page();
  return report.takeTables();
}

}  // namespace lobelia::app
