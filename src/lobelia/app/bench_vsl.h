// What the files of the study `vsl` share: figures 1, 2 and 4 to 8 of [Hasan09] on any scenes.
//
//  bench_vsl.cpp          options, scenes, figures: the study itself
//  bench_vsl_scene.cpp    a scene with its references and what is measured against them
//  bench_vsl_methods.cpp  figures 1, 2, 6 and 7: methods side by side
//  bench_vsl_curves.cpp   figure 8: error over columns, radius and clamp
//  bench_vsl_boxes.cpp    figures 4 and 5: corners, sampling
#pragma once

#include <map>
#include <set>

#include "lobelia/app/bench_figures.h"
#include "lobelia/app/bench_scene.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {

struct VslSettings {
  std::set<std::string> figures;
  std::string folder;  // of pictures; empty: numbers alone, rendered for the pixels compared
  uint64_t lights = 250'000;
  size_t rows = 0, columns = 5000;  // of --gather mrcs; rows 0: its default
  int pathSamples = 8192;           // of the reference, both halves together
  int eyeSamples = 4;               // 2 x 2, as in the paper
  bool has(int figure) const { return figures.contains(std::to_string(figure)); }
};

struct VslMethod {
  std::string key, label;
  BenchScene::Change change;
  std::string clamp;  // for tables
};

struct VslOutcome {
  Film film;
  double seconds = 0;
  Comparison error;
};

// One scene of the study. Indirect light alone; what several figures need is rendered once. When
// cancelled, results are of no use.
class VslScene {
 public:
  VslScene(const BenchOptions& options, const VslSettings& settings, const std::string& scene,
           Context& context);

  const std::string& name() const { return scene_.name(); }
  const std::string& stem() const { return stem_; }  // the name as part of a file's name
  BenchScene& scene() { return scene_; }
  const VslSettings& settings() const { return settings_; }

  const Reference& reference();
  const Film& referencePicture();
  ToneCurve toneCurve();
  const VslOutcome& outcome(const VslMethod& method);
  Comparison measure(const BenchScene::Change& change);  // of the pixels compared
  Comparison compared(const Film& film);

  struct ClampPoint {
    double clamp, l2, meanRatio;
  };
  const std::vector<ClampPoint>& clampCurve(const std::string& model);
  std::string bestClamp(const std::string& model);  // of least l2

  VslMethod clamped(const std::string& model, const std::string& label);
  VslMethod asInThePaper();  // cosine, three strategies, radius factor 8 (hall: 4)
  VslMethod ours();
  float paperRadius() const;
  void progress(const std::string& what, double fraction) const;

 private:
  void setCommon(RenderOptions& options) const;
  BenchScene::Extent extent() const;

  VslSettings settings_;
  Context& context_;
  BenchScene scene_;
  std::string stem_;
  std::optional<Reference> reference_;
  std::optional<Film> picture_;
  std::map<std::string, VslOutcome> outcomes_;
  std::map<std::string, std::vector<ClampPoint>> curves_;
};

// Figures of one scene.
void vslMethodFigures(VslScene& scene, FigureReport& report, Context& context);
void vslCurves(VslScene& scene, FigureReport& report, Context& context);
// Figures with scenes of their own.
void vslCorners(const BenchOptions& options, const VslSettings& settings, FigureReport& report,
                Context& context);
void vslSampling(const BenchOptions& options, const VslSettings& settings, FigureReport& report,
                 Context& context);

}  // namespace lobelia::app
