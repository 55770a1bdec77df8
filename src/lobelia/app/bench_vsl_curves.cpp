// Figure 8 [Hasan09]: error of the indirect light over the columns of matrix row-column sampling
// and over the radius; and that of virtual point lights over their clamp.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/app/bench_vsl.h"

namespace lobelia::app {
namespace {

constexpr size_t kColumnCounts[] = {500, 1000, 2000, 5000, 10'000, 20'000, 32'000};
constexpr size_t kRadiusColumns =
    32'000;  // "on the right we fixed the number of columns to 32,000"
constexpr float kFactors[] = {1, 2, 4, 8, 12, 0};

struct Progress {
  VslScene& scene;
  std::string what;
  size_t done = 0, all = 1;
  void next() { scene.progress(what, static_cast<double>(done++) / static_cast<double>(all)); }
};

BenchTable errorTable(const std::string& key, const std::string& title, const BenchColumn& first) {
  return {key,
          title,
          {{"scene", "scene"},
           first,
           {"vsl_l2", "VSL, our defaults: l2", "{:.3f}"},
           {"vsl_ratio", "mean ratio", "{:.4f}"},
           {"cosine_l2", "VSL, cosine: l2", "{:.3f}"},
           {"cosine_ratio", "mean ratio", "{:.4f}"}},
          {},
          {}};
}

// The paper's form but for its way of sampling, which takes ten times as long and means the same.
BenchScene::Change cosineLights(const VslScene& scene) {
  return [factor = scene.paperRadius()](RenderOptions& options) {
    options.lights = "vsl";
    options.radius = factor;
    options.sphereIndicator = "cosine";
    options.nearField = 0;
  };
}

Comparison withChange(VslScene& scene, const BenchScene::Change& lights,
                      const BenchScene::Change& more) {
  return scene.measure([&](RenderOptions& options) {
    lights(options);
    more(options);
  });
}

// The last row is all lights, each at every pixel.
void overColumns(VslScene& scene, FigureReport& report, Context& context) {
  BenchTable& table = report.table(errorTable("figure8_columns", "Figure 8: error over columns",
                                              {"columns", "columns", "{:.0f}"}));
  const size_t lights = scene.settings().lights;
  std::vector<size_t> counts;
  for (const size_t count : kColumnCounts)
    if (count < lights) counts.push_back(count);
  counts.push_back(lights);
  Progress progress{scene, "l2 over columns", 0, counts.size()};
  for (const size_t count : counts) {
    const auto columns = [&](RenderOptions& options) {
      if (count < lights) {
        options.columns = count;
      } else {
        options.gather = "all";
        options.rows = options.columns = 0;
      }
    };
    scene.reference();
    progress.next();
    const Comparison ours = withChange(scene, scene.ours().change, columns);
    const Comparison cosine = withChange(scene, cosineLights(scene), columns);
    if (context.cancelled()) return;
    table.rows.push_back({scene.name(), static_cast<double>(count), ours.l2, ours.meanRatio,
                          cosine.l2, cosine.meanRatio});
  }
  table.notes.push_back(
      fmt::format("{}: {} lights, all of them in the last row; cosine: the paper's indicator and "
                  "radius factor, {}.",
                  scene.name(), lights, scene.paperRadius()));
}

void overRadius(VslScene& scene, FigureReport& report, Context& context) {
  BenchTable& table = report.table(
      errorTable("figure8_radius", "Figure 8: error over the radius factor", {"factor", "factor"}));
  Progress progress{scene, "l2 over radius", 0, std::size(kFactors)};
  for (const float factor : kFactors) {
    const auto radius = [&](RenderOptions& options) {
      options.radius = factor;
      options.columns = kRadiusColumns;
    };
    scene.reference();
    progress.next();
    const Comparison ours = withChange(scene, scene.ours().change, radius);
    const Comparison cosine = withChange(scene, cosineLights(scene), radius);
    if (context.cancelled()) return;
    table.rows.push_back({scene.name(), factor > 0 ? fmt::format("{}", factor) : "automatic",
                          ours.l2, ours.meanRatio, cosine.l2, cosine.meanRatio});
  }
  table.notes.push_back(fmt::format("{}: {} lights, {} columns at most.", scene.name(),
                                    scene.settings().lights, kRadiusColumns));
}

void overClamp(VslScene& scene, FigureReport& report, Context& context) {
  BenchTable& table = report.table({"figure8_clamp",
                                    "Error of virtual point lights over their clamp",
                                    {{"scene", "scene"},
                                     {"clamp", "clamp", "{:.3g}"},
                                     {"vpl_l2", "vpl, l2", "{:.3f}"},
                                     {"vpl_ratio", "vpl, mean ratio", "{:.4f}"},
                                     {"glossy_l2", "glossy, l2", "{:.3f}"},
                                     {"glossy_ratio", "glossy, mean ratio", "{:.4f}"}},
                                    {},
                                    {"Clamp in 1/(scene unit)²."}});
  const auto& vpl = scene.clampCurve("vpl");
  const auto& glossy = scene.clampCurve("glossy");
  if (context.cancelled()) return;
  for (size_t i = 0; i < vpl.size(); ++i) {
    const bool off = !std::isfinite(vpl[i].clamp);
    table.rows.push_back({scene.name(), off ? BenchCell("off") : BenchCell(vpl[i].clamp), vpl[i].l2,
                          vpl[i].meanRatio, glossy[i].l2, glossy[i].meanRatio});
  }
}

}  // namespace

void vslCurves(VslScene& scene, FigureReport& report, Context& context) {
  if (!context.cancelled()) overClamp(scene, report, context);
  if (!context.cancelled()) overColumns(scene, report, context);
  if (!context.cancelled()) overRadius(scene, report, context);
}

}  // namespace lobelia::app
