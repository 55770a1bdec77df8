// A frame of the interactive renderer from precomputed transfer [P002 section 7.1]: for the
// vertices around a tile's hits their slices are interpolated between directions, once; for each
// pixel between vertices; each lobe then is one lookup in the prefiltered light.
#pragma once

#include <memory>

#include "lobelia/film/film.h"
#include "lobelia/path/emitter_sampling.h"
#include "lobelia/transfer/prefiltered_light.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::transfer {

struct TransferFrameSettings {
  int spp = 1;          // 1: through the pixel's middle, else by the camera's filter
  double rotation = 0;  // of the light, degrees about the environment's vertical (else +y)
  // Passes shown: [firstPass, endPass); 0 alone is direct light.
  int firstPass = 0, endPass = 1 << 20;
  bool hideEmitters = false;
};

class TransferRenderer {
 public:
  // Keeps references.
  TransferRenderer(const Tracer& tracer, const TransferData& data);
  ~TransferRenderer();
  // Before the first frame, and when the scene's emitters have changed, of which `emitters` is
  // made. Convolves the light from infinity, which takes a second or so, where it is another than
  // before, and says whether it was. Seconds: "light".
  bool relight(const EmitterSampler& emitters, Context& context);
  // Fills the film's picture (layer ""). Same pixels for any number of threads. Seconds: "buffer",
  // "merge" (slices at vertices), "shade", shared out as threads spent theirs. Counts: "frames",
  // "pixels", "object_pixels", "vertices_merged", "light_lookups", "nonfinite". Throws Cancelled.
  void render(const TransferFrameSettings& settings, const Camera& camera, Film& film,
              Context& context);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia::transfer
