#include "lobelia/app/bench_vmf.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/app/bench_studies.h"

namespace lobelia::app {
namespace {

struct FigureScenes {
  const char* figure;
  std::vector<std::string> scenes;
};
const std::vector<FigureScenes>& ownScenes() {
  static const std::vector<FigureScenes> scenes{
      {"table1",
       {"bird", "dragon", "glasses", "teapot-32", "teapot-64", "teapot-128", "teapot-256"}},
      {"hash", {"teapot-32", "teapot-64", "teapot-128", "teapot-256", "teapot-512"}},
      {"1", {"glasses"}},
      {"2", {"bird", "dragon", "glasses"}},
      {"3", {"teapot-128", "glasses"}},
      {"4", {"teapot-128", "glasses"}}};
  return scenes;
}

// All scenes that these figures look at, in the figures' order.
std::vector<std::string> scenesOf(const std::set<std::string>& figures,
                                  const std::vector<std::string>& asked) {
  if (!asked.empty()) return asked;
  std::vector<std::string> scenes;
  for (const FigureScenes& own : ownScenes())
    if (figures.contains(own.figure))
      for (const std::string& scene : own.scenes)
        if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
  return scenes;
}

}  // namespace

void VmfStudy::progress(const std::string& scene, const std::string& what) const {
  context.progress(fmt::format("{}{}, {}", kBenchStage, scene, what), 0.5);
}

std::string VmfKind::name() const {
  return fmt::format("{} directions{}", directions(),
                     materials ? ", a lobe for each material" : "");
}

transfer::TransferSettings settingsOf(const VmfKind& kind, const Scene& scene,
                                      const VmfStudy& study) {
  transfer::TransferSettings settings;
  settings.directionLevel = kind.directionLevel;
  settings.rayLevel = kind.rayLevel;
  settings.mostVertices = study.options.pixels;
  if (kind.materials)
    settings.classCount =
        std::clamp(static_cast<int>(scene.materials.size()), 1, transfer::kMostClasses);
  return settings;
}

VmfData makeTransfer(const Tracer& tracer, const VmfKind& kind, const VmfStudy& study) {
  const Statistics& s = study.context.statistics;
  const double masks = s.seconds("masks");
  const uint64_t rays = s.count("transfer_rays");
  const int64_t start = nanosecondsNow();
  VmfData made;
  made.data =
      transfer::precomputeTransfer(tracer, settingsOf(kind, tracer.scene(), study), study.context);
  made.masks = s.seconds("masks") - masks;
  made.rest = 1e-9 * static_cast<double>(nanosecondsNow() - start) - made.masks;
  made.rays = static_cast<double>(s.count("transfer_rays") - rays);
  return made;
}

const std::vector<std::string>& vmfFigures() {
  static const std::vector<std::string> figures{"table1", "hash", "1", "2", "3", "4"};
  return figures;
}

std::vector<BenchTable> benchVmf(const BenchOptions& options, Context& context) {
  const std::set<std::string> figures = chosenOf("--figures", options.figures, vmfFigures());
  FigureReport report(options.output, "vmf", "Multi-bounce glossy transfer");
  const VmfStudy study{options, report, context};
  for (const std::string& scene : scenesOf(figures, options.scenes)) {
    const auto wants = [&](const char* figure) {
      if (!figures.contains(figure) || context.cancelled()) return false;
      if (!options.scenes.empty()) return true;
      for (const FigureScenes& own : ownScenes())
        if (own.figure == std::string_view(figure))
          return std::find(own.scenes.begin(), own.scenes.end(), scene) != own.scenes.end();
      return false;
    };
    try {
      if (const bool table = wants("table1"), hash = wants("hash"); table || hash)
        vmfTable(scene, table, hash, study);
      if (const bool one = wants("1"), two = wants("2"), four = wants("4"); one || two || four)
        vmfError(scene, one, two, four, study);
      if (wants("3")) vmfScatter(scene, study);
    } catch (const Cancelled&) {
      context.warning(fmt::format("stopped at {}: the tables have what there is so far", scene));
    }
    report.writePage(options.commandLine);
  }
  return report.takeTables();
}

}  // namespace lobelia::app
