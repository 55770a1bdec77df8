// What the files of the study `vmf` share: multi-bounce glossy transfer [P002] on any scenes.
//
//  bench_vmf.cpp          options, scenes, figures: the study itself
//  bench_vmf_table.cpp    table 1: size and time of the data, frames per second; density of the
//                         paper's table of displaced rows
//  bench_vmf_views.h      pictures from data beside those of the path tracer, from several sides
//  bench_vmf_error.cpp    figures 1, 2 and 4: bounce by bounce, and all, against the path tracer
//  bench_vmf_scatter.cpp  figure 3: scattering at equal rays
#pragma once

#include "lobelia/app/bench_figures.h"
#include "lobelia/app/bench_scene.h"
#include "lobelia/transfer/precompute.h"

namespace lobelia::app {

struct VmfStudy {
  const BenchOptions& options;
  FigureReport& report;
  Context& context;
  bool cancelled() const { return context.cancelled(); }
  void progress(const std::string& scene, const std::string& what) const;
};

// A choice of data: how many directions to the eye, whether each material has a lobe, and of which
// grid the rays are (TransferSettings::rayLevel).
struct VmfKind {
  int directionLevel = 3;
  bool materials = false;
  int rayLevel = 0;
  size_t directions() const { return 10 * (size_t{1} << 2 * directionLevel) + 2; }
  std::string name() const;  // for people
};
transfer::TransferSettings settingsOf(const VmfKind& kind, const Scene& scene,
                                      const VmfStudy& study);

// Data and what they took.
struct VmfData {
  transfer::TransferData data;
  double masks = 0, rest = 0;  // seconds: of masks and subdivision, and of all else
  double rays = 0;             // of gathering
};
VmfData makeTransfer(const Tracer& tracer, const VmfKind& kind, const VmfStudy& study);

void vmfTable(const std::string& scene, bool table1, bool hash, const VmfStudy& study);
void vmfError(const std::string& scene, bool figure1, bool figure2, bool figure4,
              const VmfStudy& study);
void vmfScatter(const std::string& scene, const VmfStudy& study);

}  // namespace lobelia::app
