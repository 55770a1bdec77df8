// Table 2 and figures 4 to 9 of [P000] with one command: the study's options, its scenes and which
// figures they have (bench_sglc.h says where the rest is).
#include "lobelia/app/bench_sglc.h"

#include "lobelia/app/bench_studies.h"

namespace lobelia::app {
namespace {

const std::vector<std::string> kScenes = {"box", "tableau", "treasure", "kitchen"};
// Figures 8 and 9 of the study's own scenes, and the view of the former.
constexpr const char* kKitchen = "kitchen";
constexpr const char* kSecondView = "second";

SglcSettings settingsOf(const BenchOptions& options) {
  SglcSettings settings;
  settings.figures = chosenOf("--figures", options.figures, sglcFigures());
  settings.methods = chosenOf("--methods", options.methods, sglcMethodKeys());
  settings.folder = options.output;
  if (options.lightCount > 0) settings.lights = options.lightCount;
  return settings;
}

// Of one scene; `kitchens`: has it the figures that of the study's own scenes only the kitchen has?
void figuresOf(const std::string& name, bool kitchens, const BenchOptions& options,
               const SglcSettings& settings, FigureReport& report, Context& context) {
  const SglcView view{name, "", "", settings.lights};
  const bool ofView = settings.has("table2") || settings.hasLayers() || settings.has("6") ||
                      settings.has("7") || settings.has("floors") || settings.has("frames");
  const bool growth = settings.has("9a") || settings.has("9b");
  if (ofView || (kitchens && growth)) {
    SglcScene scene(options, settings, view, context);
    if (settings.has("table2") && !context.cancelled()) sglcTable(scene, report, context);
    if (settings.hasLayers() && !context.cancelled()) sglcLayers(scene, report, context);
    if ((settings.has("6") || settings.has("7")) && !context.cancelled())
      sglcBounds(scene, report, context);
    if (settings.has("floors") && !context.cancelled()) sglcFloors(scene, report, context);
    if (kitchens && settings.has("9a") && !context.cancelled())
      sglcLightGrowth(options, scene, report, context);
    if (kitchens && settings.has("9b") && !context.cancelled())
      sglcPixelGrowth(options, scene, report, context);
    if (settings.has("frames") && !context.cancelled()) sglcFrames(scene, report, context);
  }
  if (kitchens && settings.has("8") && !context.cancelled()) {
    SglcView second = view;
    if (name == kKitchen && options.camera.empty()) second.camera = kSecondView;
    SglcScene scene(options, settings, second, context);
    sglcEqualTime(scene, report, context);
  }
}

}  // namespace

const std::vector<std::string>& sglcFigures() {
  static const std::vector<std::string> figures{"table2", "4",  "5",  "6",      "7",
                                                "8",      "9a", "9b", "floors", "frames"};
  return figures;
}

std::vector<BenchTable> benchSglc(const BenchOptions& options, Context& context) {
  const SglcSettings settings = settingsOf(options);
  FigureReport report(settings.folder, "sglc",
                      "Spherical-Gaussian lightcuts: table 2 and figures of [P000]");
  const bool own = options.scenes.empty();
  for (const std::string& name : own ? kScenes : options.scenes) {
    if (context.cancelled()) break;
    figuresOf(name, !own || name == kKitchen, options, settings, report, context);
    report.writePage(options.commandLine);
  }
  return report.takeTables();
}

}  // namespace lobelia::app
