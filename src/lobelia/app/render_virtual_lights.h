// Rendering with virtual lights: lights once, then receivers and gather, band by band.
#pragma once

#include <optional>

#include "lobelia/app/cut_export.h"
#include "lobelia/app/light_reduction.h"
#include "lobelia/base/checkpoints.h"
#include "lobelia/film/film.h"
#include "lobelia/film/film_preview.h"

namespace lobelia::app {

struct VirtualLightReport {  // for --stats
  LightCounts lights;        // the first set
  int sets = 1;              // independent sets that were averaged
  ReductionReport reduction;
  uint64_t photons = 0;  // of the first set (--lights photon)
  uint64_t diffuseReceivers = 0, glossyReceivers = 0, receiverPoints = 0;
  std::optional<CutExport> cuts;  // of the first sample, where --export-trees asks for them
};

// Adds to film's layers "direct" and "indirect" (and AOVs). When cancelled or out of time, every
// pixel holds the mean of the samples it got; pixels without any have alpha 0. checkpoints: where
// to save the state and to go on from; preview: who looks on. Null: nowhere, nobody. firstSet: the
// first set of lights, which another frame may have made already; when empty, it gets a copy.
VirtualLightReport renderVirtualLights(const Tracer& tracer, const EmitterSampler& emitters,
                                       const Camera& camera, const PixelSet& pixels, int maxDepth,
                                       const RenderOptions& options, Film& film, Context& context,
                                       Checkpoints* checkpoints = nullptr,
                                       FilmPreview* preview = nullptr,
                                       std::optional<VirtualLights>* firstSet = nullptr);

}  // namespace lobelia::app
