// What the files of the study `vsgl` share: virtual spherical Gaussian lights on any scenes.
//
//  bench_vsgl.cpp           options, scenes, figures: the study itself
//  bench_vsgl_sampling.cpp  ways of clustering the same texels, against all of them
//  bench_vsgl_time.cpp      time of a picture by kinds of shadows; cuts of the light tree
#pragma once

#include <set>

#include "lobelia/app/bench_figures.h"
#include "lobelia/app/bench_scene.h"
#include "lobelia/app/bench_spent.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {

struct VsglStudy {
  const BenchOptions& options;
  FigureReport& report;
  Context& context;
  int pathSamples = 1024;  // of the reference, both halves together
  std::string stem(const BenchScene& scene) const;
  bool cancelled() const { return context.cancelled(); }
  void progress(const BenchScene& scene, const std::string& what) const;
};

inline constexpr uint64_t kVsglSeed = 61, kVsglReferenceSeed = 62;

// Filtered importance sampling, k-means and tree cuts of 2 to 4,096 lights, one bounce.
void vsglSampling(const std::string& scene, const VsglStudy& study);
// 960x540, 1,024 lights; the preview with two.
void vsglTime(const std::string& scene, const VsglStudy& study);
// Mode `unbiased` of sglc over growing cuts with point lights and with VSGLs.
void vsglCuts(const std::string& scene, const VsglStudy& study);

}  // namespace lobelia::app
