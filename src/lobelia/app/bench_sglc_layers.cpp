// Figures 4 and 5 [P000], and the decompositions of its figure 6: light by pairing of lights and
// receivers, and what pixels cost. The paper's false colours are of nodes; ours of shadow rays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/bench_sglc.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/film/color_map.h"

namespace lobelia::app {
namespace {

const char* wordsOf(char light) {
  switch (light) {
    case 'o':
      return "omni";
    case 'n':
      return "directional";
    case 'd':
      return "diffuse";
    case 's':
      return "glossy";
    case 'g':
      return "spherical Gaussian";
    default:
      return "spherical";
  }
}
std::string pairingName(const std::string& layer) {
  return fmt::format("{} to {}", wordsOf(layer[0]), wordsOf(layer[1]));
}

Film layerAlone(const Film& film, const std::string& layer) {
  Film out = film;
  Layer values = film.layers.at(layer);
  out.layers.clear();
  out.layers[""] = std::move(values);
  return out;
}

void addPairings(SglcScene& scene, const SglcMethod& method, BenchTable* table,
                 FigureReport& report, std::vector<FigurePicture>* line) {
  const SglcOutcome& outcome = scene.outcome(method);
  const double whole = meanLuminance(outcome.film);
  for (const std::string& layer : typeLayers()) {
    const Film alone = layerAlone(outcome.film, layer);
    const double mean = meanLuminance(alone);
    if (mean == 0) continue;
    const Comparison error = compare(alone, layerAlone(scene.reference().film, layer));
    const std::string file =
        report.picture(fmt::format("figure4-{}-{}-{}", scene.stem(), method.key, layer),
                       toneMap(outcome.film, scene.toneCurve(), layer), outcome.film);
    table->rows.push_back({scene.stem(), method.label, pairingName(layer), mean / whole, error.l2,
                           error.meanRatio, file});
    line->push_back({method.label + ": " + pairingName(layer), file});
  }
}

// What the rays of pixels are, as a row and in false colours.
FigurePicture addCost(SglcScene& scene, const SglcMethod& method, BenchTable* table,
                      FigureReport& report) {
  const Film& film = scene.outcome(method).film;
  std::vector<float> rays = film.layers.at("cost").values;
  std::sort(rays.begin(), rays.end());
  const auto quantile = [&](double q) {
    return static_cast<double>(rays[static_cast<size_t>(q * static_cast<double>(rays.size() - 1))]);
  };
  double sum = 0;
  for (const float r : rays) sum += static_cast<double>(r);
  const FalseColors colors = falseColors(film, "cost");
  const std::string file = report.picture(
      fmt::format("figure4-{}-{}-cost", scene.stem(), method.key), colors.pixels, film);
  table->rows.push_back({scene.stem(), method.label, sum / static_cast<double>(rays.size()),
                         quantile(0.5), quantile(0.99), quantile(1), file});
  return {fmt::format("{}: {:.0f} (black) to {:.0f} rays (white)", method.label, colors.least,
                      colors.most),
          file};
}

}  // namespace

void sglcLayers(SglcScene& scene, FigureReport& report, Context& context) {
  BenchTable& table = report.table(
      {"figure4",
       "Figures 4 and 5: light by pairing",
       {{"scene", "scene"},
        {"method", "method"},
        {"pairing", "pairing"},
        {"share", "share of the light", "{:.3f}"},
        {"l2", "l2", "{:.4f}"},
        {"mean_ratio", "mean ratio", "{:.4f}"},
        {"picture", "picture"}},
       {},
       {"Lights to receivers' lobes, of the pairings that have light; l2 is relative to the "
        "pairing's own light. Emitters that are seen belong to no pairing."}});
  BenchTable& cost = report.table({"figure4_cost",
                                   "Figures 4 and 5: shadow rays of pixels",
                                   {{"scene", "scene"},
                                    {"method", "method"},
                                    {"mean", "mean", "{:.1f}"},
                                    {"median", "median", "{:.1f}"},
                                    {"high", "99th percentile", "{:.1f}"},
                                    {"most", "most", "{:.1f}"},
                                    {"picture", "picture"}},
                                   {},
                                   {}});
  std::vector<FigurePicture> heat;
  for (const SglcMethod& plain : {defaultMethod(), approximateMethod()}) {
    const SglcMethod method = withLayers(plain);
    const SglcOutcome& outcome = scene.outcome(method);
    if (context.cancelled()) return;
    std::vector<FigurePicture> line{
        {method.label, report.picture(fmt::format("figure4-{}-{}", scene.stem(), method.key),
                                      outcome.film, scene.toneCurve())}};
    addPairings(scene, method, &table, report, &line);
    report.show("figure4", scene.stem() + ", " + method.label, std::move(line));

    heat.push_back(addCost(scene, method, &cost, report));
  }
  table.notes.push_back(scene.description());
  report.show("figure4_cost", scene.stem(), std::move(heat));
}

}  // namespace lobelia::app
