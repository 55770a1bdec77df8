// Table 2 [P000]: what the scenes have, and seconds by stage, rays, nodes and error of every
// strategy; the paper's figures beside, where it has the scene.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "lobelia/app/bench_sglc.h"

namespace lobelia::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// [P000 table 2]: lights and receivers in thousands; rays per pixel and seconds by E_c and E_a.
struct PaperRow {
  const char* scene;
  double triangles, direct, diffuseLights, glossyLights, diffusePixels, glossyPixels;
  double conservativeRays, approximateRays, conservativeSeconds, approximateSeconds;
};
constexpr PaperRow kPaper[] = {{"box", 135, 5, 2970, 2800, 479, 466, 2481, 1059, 46, 25},
                               {"tableau", 222, 0.003, 520, 530, 397, 397, kNone, 1091, kNone, 34},
                               {"treasure", 918, 50, 1600, 1600, 300, 290, 2857, 1175, 53, 29},
                               {"kitchen", 184, 10, 2600, 2900, 480, 480, 3309, 1342, 76, 37}};

const PaperRow* paperRow(const std::string& scene) {
  const auto* found = std::find_if(std::begin(kPaper), std::end(kPaper),
                                   [&](const PaperRow& row) { return scene == row.scene; });
  return found == std::end(kPaper) ? nullptr : found;
}

void sceneRow(SglcScene& scene, FigureReport& report) {
  BenchTable& table = report.table(
      {"table2_scenes",
       "Table 2: scenes; ours / the paper's",
       {{"scene", "scene"},
        {"triangles", "triangles", "{:.0f}"},
        {"direct", "direct lights", "{:.0f}"},
        {"diffuse_lights", "diffuse lights", "{:.0f}"},
        {"glossy_lights", "glossy lights", "{:.0f}"},
        {"diffuse_receivers", "diffuse receivers", "{:.0f}"},
        {"glossy_receivers", "glossy receivers", "{:.0f}"},
        {"paper_triangles", "paper: triangles", "{:.0f}"},
        {"paper_direct", "direct lights", "{:.0f}"},
        {"paper_diffuse_lights", "diffuse lights", "{:.0f}"},
        {"paper_glossy_lights", "glossy lights", "{:.0f}"},
        {"paper_diffuse_receivers", "diffuse pixels", "{:.0f}"},
        {"paper_glossy_receivers", "glossy pixels", "{:.0f}"}},
       {},
       {"The paper's [P000 table 2] at 800x600 and, rounded there, in thousands. Receivers are "
        "lobes: a pixel may be both."}});
  const SglcOutcome& ours = scene.outcome(defaultMethod());
  const VirtualLights& lights = scene.lights();
  std::vector<BenchCell> row{scene.stem(),
                             static_cast<double>(triangleCount(scene.scene().tracer().scene())),
                             static_cast<double>(lights.omni.size() + lights.directional.size()),
                             static_cast<double>(lights.diffuse.size()),
                             static_cast<double>(lights.glossy.size()),
                             static_cast<double>(ours.report.diffuseReceivers),
                             static_cast<double>(ours.report.glossyReceivers)};
  const PaperRow* paper = paperRow(scene.name());
  const PaperRow p =
      paper ? *paper : PaperRow{"", kNone, kNone, kNone, kNone, kNone, kNone, 0, 0, 0, 0};
  for (const double thousands :
       {p.triangles, p.direct, p.diffuseLights, p.glossyLights, p.diffusePixels, p.glossyPixels})
    row.emplace_back(1000 * thousands);
  table.rows.push_back(std::move(row));
}

BenchTable emptyTable() {
  return {"table2",
          "Table 2: gathering",
          {{"scene", "scene"},
           {"method", "method"},
           {"seconds", "seconds", "{:.2f}"},
           {"trees", "trees", "{:.2f}"},
           {"traverse", "traverse", "{:.2f}"},
           {"visibility", "visibility", "{:.2f}"},
           {"shade", "shade", "{:.2f}"},
           {"rays_per_pixel", "rays per pixel", "{:.1f}"},
           {"visited_per_pixel", "nodes visited per pixel", "{:.1f}"},
           {"shaded_per_pixel", "pairs shaded per pixel", "{:.1f}"},
           {"lights_per_node", "lights per node", "{:.1f}"},
           {"receivers_per_node", "receivers per node", "{:.1f}"},
           {"l2", "l2", "{:.4f}"},
           {"mean_ratio", "mean ratio", "{:.4f}"},
           {"paper_rays_per_pixel", "paper: rays per pixel", "{:.0f}"},
           {"paper_seconds", "paper: seconds", "{:.0f}"}},
          {},
          {"Seconds of gathering without receivers and light pass; what is not in the stages is "
           "other preparation (of mrcs, which has as many columns as a cut has lights: rows and "
           "clusters). l2 and mean ratio against every light "
           "at the pixels compared. \"every light\": seconds extrapolated from those pixels. The "
           "paper's: [P000 table 2], 800x600 on a GTX Titan with its numbers of lights."}};
}

void methodRow(SglcScene& scene, const SglcMethod& method, double paperRays, double paperSeconds,
               BenchTable* table) {
  const SglcOutcome& o = scene.outcome(method);
  table->rows.push_back({scene.stem(), method.label, o.seconds, o.trees, o.traverse, o.visibility,
                         o.shade, o.per(o.rays), o.visitedOrNone(), o.per(o.shaded),
                         o.lightsPerNode > 0 ? o.lightsPerNode : kNone,
                         o.receiversPerNode > 0 ? o.receiversPerNode : kNone, o.error.l2,
                         o.error.meanRatio, paperRays, paperSeconds});
}

}  // namespace

void sglcTable(SglcScene& scene, FigureReport& report, Context& context) {
  sceneRow(scene, report);
  BenchTable& table = report.table(emptyTable());
  const PaperRow* paper = paperRow(scene.name());
  std::vector<FigurePicture> line;
  const auto add = [&](const SglcMethod& method, double rays, double seconds) {
    scene.outcome(method);
    if (context.cancelled()) return;
    methodRow(scene, method, rays, seconds, &table);
    line.push_back(
        {method.label, report.picture(fmt::format("table2-{}-{}", scene.stem(), method.key),
                                      scene.outcome(method).film, scene.toneCurve())});
  };
  for (const SglcMethod& method : sglcMethods(scene.settings())) {
    const bool asInThePaper = method.key == approximateMethod().key;
    add(method, asInThePaper && paper ? paper->approximateRays : kNone,
        asInThePaper && paper ? paper->approximateSeconds : kNone);
    if (asInThePaper) {
      add(conservative(method), paper ? paper->conservativeRays : kNone,
          paper ? paper->conservativeSeconds : kNone);
    }
  }
  const SglcOutcome& all = scene.reference();
  if (context.cancelled()) return;
  table.rows.push_back({scene.stem(), "every light", scene.bruteForceSeconds(), kNone, kNone, kNone,
                        kNone, all.per(all.rays), kNone, all.per(all.shaded), kNone, kNone, kNone,
                        kNone, kNone, kNone});
  table.notes.push_back(scene.description());
  report.show("table2", scene.stem(), std::move(line));
}

}  // namespace lobelia::app
