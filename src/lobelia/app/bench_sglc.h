// What the files of the study `sglc` share: table 2 and figures 4 to 9 of [P000], for every gather
// strategy that there is (or for --methods), on any scenes.
//
//  bench_sglc.cpp          options, scenes, figures: the study itself
//  bench_sglc_scene.cpp    a scene with its lights, its reference and what is measured against it
//  bench_sglc_methods.cpp  strategies, and the option that sets the quality of each
//  bench_sglc_table.cpp    table 2
//  bench_sglc_layers.cpp   figures 4 and 5: light by pairing, cost of pixels
//  bench_sglc_curves.cpp   figures 6 and 7 (conservative and approximate bounds) and 8 (equal time)
//  bench_sglc_growth.cpp   figure 9: growth with lights (9a) and pixels (9b)
//  bench_sglc_frames.cpp   frames of a camera that moves: how the error changes between them
//  bench_sglc_floors.cpp   what a gather would take at the bare rates of its parts
//
// Deviations from the paper: all of a picture's light is that of virtual lights, as there, but the
// reference is the brute force of the same lights at some pixels of the picture. Figures are of the
// paper's kinds on all scenes, not each on one.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>

#include "lobelia/app/bench_figures.h"
#include "lobelia/app/bench_scene.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {

struct SglcSettings {
  std::set<std::string> figures, methods;  // by name and key
  std::string folder;                      // of pictures; empty: numbers alone
  uint64_t lights = 100'000;
  bool has(const char* figure) const { return figures.contains(figure); }
  bool hasLayers() const { return has("4") || has("5"); }
};

struct SglcMethod {
  std::string key, label;
  BenchScene::Change change;
};
// The option by which a strategy trades time for error, and values to try.
struct SglcQuality {
  std::string option;
  double normal;  // the default
  std::vector<double> values;
  void (*set)(RenderOptions&, double);
};

// All strategies but brute force, sglc by its modes, and --lights richvpl by its forms; those of
// them that the study is to have.
std::vector<SglcMethod> sglcMethods(const SglcSettings& settings);
SglcMethod everyLight();  // brute force
SglcMethod defaultMethod();
SglcMethod conservative(SglcMethod paper);               // sglc in mode paper by E_c
SglcMethod withLayers(SglcMethod method);                // by pairing, and rays of pixels
SglcMethod approximateMethod();                          // sglc in mode paper by E_a
const SglcQuality* qualityOf(const SglcMethod& method);  // null: none that is known
SglcMethod withQuality(SglcMethod method, const SglcQuality& quality, double value);

// Counts and seconds of the gather alone, without receivers and light pass.
struct SglcOutcome {
  Film film;
  VirtualLightReport report;
  double pixels = 0;
  double seconds = 0, trees = 0, traverse = 0, visibility = 0, shade = 0;
  double rays = 0, sharedRays = 0, visited = 0, shaded = 0, cutNodes = 0;  // of the picture
  double lightsPerNode = 0, receiversPerNode = 0;
  Comparison error;  // against the reference, at its pixels
  double per(double count) const { return count / pixels; }
  // Per pixel; NaN of a strategy that visits no nodes.
  double visitedOrNone() const {
    return visited > 0 ? per(visited) : std::numeric_limits<double>::quiet_NaN();
  }
};

struct SglcView {
  std::string scene, camera, size;  // "": as the options say
  uint64_t lights = 0;
};

// A view of a scene and one set of lights. What several figures need is rendered once. When
// cancelled, results are of no use.
class SglcScene {
 public:
  SglcScene(const BenchOptions& options, const SglcSettings& settings, const SglcView& view,
            Context& context);

  const std::string& name() const { return scene_.name(); }
  const std::string& stem() const { return stem_; }  // the name as part of a file's name
  BenchScene& scene() { return scene_; }
  const SglcSettings& settings() const { return settings_; }
  const SglcView& view() const { return view_; }

  const SglcOutcome& reference();  // every light, at the pixels compared
  const SglcOutcome& outcome(const SglcMethod& method);
  // Seconds of brute force for the whole picture, at the rate of the reference.
  double bruteForceSeconds();
  // Of the whole picture, as all methods have them.
  std::pair<Receivers, GatherSettings> receivers();
  const VirtualLights& lights();
  ToneCurve toneCurve();  // of the default's picture
  bool referenceIsWhole() const { return scene_.pixelCount() == scene_.pictureCount(); }
  // Options of the study's lights and receivers as a method gathers them.
  BenchScene::Change changeOf(const SglcMethod& method) const;
  void progress(const std::string& what) const;
  std::string description() const;  // for notes

 private:
  SglcOutcome measure(const SglcMethod& method, BenchScene::Extent extent);

  SglcSettings settings_;
  SglcView view_;
  Context& context_;
  BenchScene scene_;
  std::string stem_;
  std::optional<VirtualLights> lights_;
  std::optional<SglcOutcome> reference_;
  std::map<std::string, SglcOutcome> outcomes_;
};

// Figures of one scene.
void sglcTable(SglcScene& scene, FigureReport& report, Context& context);
void sglcLayers(SglcScene& scene, FigureReport& report, Context& context);
void sglcBounds(SglcScene& scene, FigureReport& report, Context& context);
void sglcFloors(SglcScene& scene, FigureReport& report, Context& context);
void sglcEqualTime(SglcScene& scene, FigureReport& report, Context& context);
void sglcLightGrowth(const BenchOptions& options, SglcScene& scene, FigureReport& report,
                     Context& context);
void sglcPixelGrowth(const BenchOptions& options, SglcScene& scene, FigureReport& report,
                     Context& context);
void sglcFrames(SglcScene& scene, FigureReport& report, Context& context);

}  // namespace lobelia::app
