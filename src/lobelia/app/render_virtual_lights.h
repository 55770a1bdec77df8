// Rendering with virtual lights: lights once, then receivers and gather, band by band.
#pragma once

#include "lobelia/app/render_options.h"
#include "lobelia/base/checkpoints.h"
#include "lobelia/film/film.h"
#include "lobelia/film/film_preview.h"
#include "lobelia/gather/gather.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia::app {

struct VirtualLightReport {  // for --stats
  VirtualLights lights;      // the first set
  int sets = 1;              // independent sets that were averaged
  uint64_t photons = 0;      // of the first set (--lights photon)
  uint64_t diffuseReceivers = 0, glossyReceivers = 0, receiverPoints = 0;
};

// Adds to film's layers "direct" and "indirect" (and AOVs). When cancelled or out of time, every
// pixel holds the mean of the samples it got; pixels without any have alpha 0. checkpoints: where
// to save the state and to go on from; preview: who looks on. Null: nowhere, nobody. firstSet: the
// first set of lights when it is made already (another frame's report has it).
VirtualLightReport renderVirtualLights(const Tracer& tracer, const EmitterSampler& emitters,
                                       const Camera& camera, const PixelSet& pixels, int maxDepth,
                                       const RenderOptions& options, Film& film, Context& context,
                                       Checkpoints* checkpoints = nullptr,
                                       FilmPreview* preview = nullptr,
                                       const VirtualLights* firstSet = nullptr);

}  // namespace lobelia::app
