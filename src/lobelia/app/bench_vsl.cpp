// Figures of [Hasan09] with one command: the study's options, its scenes and which figures they
// have (bench_vsl.h says where the rest is).
#include "lobelia/app/bench_vsl.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "lobelia/app/bench_studies.h"

namespace lobelia::app {
namespace {

const std::vector<std::string> kScenes = {"kitchen-stove", "hall", "tableau-ward"};

std::set<int> parseFigures(const std::string& text) {
  if (text.empty()) return {std::begin(kVslFigures), std::end(kVslFigures)};
  std::set<int> figures;
  for (const char *p = text.data(), *end = p + text.size();; ++p) {
    int figure = 0;
    const auto [next, error] = std::from_chars(p, end, figure);
    const bool known =
        std::find(std::begin(kVslFigures), std::end(kVslFigures), figure) != std::end(kVslFigures);
    if (error != std::errc() || !known || (next != end && *next != ',')) {
      throw UsageError(fmt::format(
          "--figures '{}': figures are separated by commas; there are 1, 2, 4, 5, 6, 7 and 8",
          text));
    }
    figures.insert(figure);
    if (next == end) return figures;
    p = next;
  }
}

VslSettings settingsOf(const BenchOptions& options) {
  VslSettings s;
  s.figures = parseFigures(options.figures);
  s.folder = options.output;
  if (options.lightCount > 0) s.lights = options.lightCount;
  if (options.columns > 0) s.columns = options.columns;
  s.rows = options.rows;
  if (options.spp > 0) s.pathSamples = options.spp;
  return s;
}

}  // namespace

std::vector<BenchTable> benchVsl(const BenchOptions& options, Context& context) {
  const VslSettings settings = settingsOf(options);
  VslReport report(settings.folder);
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
