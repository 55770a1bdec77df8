// What the files of the study `cuts` share: visibility cuts [P004] on any scenes.
//
//  bench_cuts.cpp           options, scenes, figures: the study itself
//  bench_cuts_vertices.h    what some vertices see of any directions, for figures 5 and 8
//  bench_cuts_clusters.cpp  figures 5 and 8 (b): clusters of directions by three metrics
//  bench_cuts_wavelets.cpp  figure 8 (a): terms of cuts and of Haar wavelets (haar.h, study_tree.h)
//  bench_cuts_materials.cpp figure 6: an object in many materials (bench_cuts_designs.h)
//  bench_cuts_frames.h      frames for figures 6 and 10
//  bench_cuts_bounce.cpp    figure 7: light of lamps, direct and with one bounce
//  bench_cuts_data.cpp      figure 9: size and time of the data, frames per second
//  bench_cuts_local.cpp     figure 9: the same under local lights
//  bench_cuts_error.cpp     figure 10: error of frames by the size of the light cut; and by sigma
#pragma once

#include <optional>

#include "lobelia/app/bench_figures.h"
#include "lobelia/app/bench_scene.h"
#include "lobelia/relight/frame.h"
#include "lobelia/relight/precompute.h"

namespace lobelia::app {

struct CutsStudy {
  const BenchOptions& options;
  FigureReport& report;
  Context& context;
  bool cancelled() const { return context.cancelled(); }
  void progress(const std::string& scene, const std::string& what) const;
  // For this scene; direct light unless the options say more.
  BenchOptions optionsOf(const std::string& scene) const;
  size_t sampleCount() const;  // of directions; throws UsageError
};

inline constexpr float kLocalSigma = 0.85f;  // of surface data: RMS errors are about the paper's
inline constexpr size_t kPaperLightCuts[] = {128, 256, 512};

Film emptyFrame(const Camera& camera);
// The camera of frames that are timed: 640x480 unless the options say more.
Camera timedCamera(const Scene& scene, const BenchOptions& options);
// Roughnesses of frame i of those, up to a fifth more or less than they were.
void changeRoughness(std::vector<Material>& materials, int i);

class StudyVertices;
void cutsClusters(const std::string& scene, const Tracer& tracer, const StudyVertices& vertices,
                  bool figure5, bool figure8, const CutsStudy& study);
void cutsWavelets(const std::string& scene, const StudyVertices& vertices, const CutsStudy& study);
void cutsMaterials(const std::string& scene, const CutsStudy& study);
// Data of light from a scene's surfaces; none, and a word about it, where no light is local.
std::optional<relight::VisibilityData> surfaceData(const std::string& scene, const Tracer& tracer,
                                                   const char* figure, const CutsStudy& study);
void cutsBounce(const std::string& scene, const CutsStudy& study);
void cutsData(const std::string& scene, const CutsStudy& study);
void cutsLocalData(const std::string& scene, const CutsStudy& study);
void cutsError(const std::string& scene, bool lightCuts, bool sigmas, const CutsStudy& study);

}  // namespace lobelia::app
