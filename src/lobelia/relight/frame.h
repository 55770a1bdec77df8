// A frame of the interactive renderer: light from infinity that arrives straight at the first
// surface, with shadows by visibility cuts [P004 section 4.2].
//
// On the CPU the deferred buffer is a tile's: rays in packets, the vertices around their hits, one
// merge for each vertex, then pixel after pixel. Nothing of it leaves the caches of a core.
#pragma once

#include <memory>

#include "lobelia/film/film.h"
#include "lobelia/path/emitter_sampling.h"
#include "lobelia/relight/frame_light.h"
#include "lobelia/relight/visibility_data.h"

namespace lobelia::relight {

struct FrameSettings {
  int spp = 1;          // 1: through the pixel's middle, else by the camera's filter
  bool refined = true;  // finer light where lobes are narrow
  bool hideEmitters = false;
};

// What the frames of a scene share; keeps references.
class FrameRenderer {
 public:
  // data: of light from an environment, or this throws UsageError. emitters: of the scene of the
  // tracer, whose emitters may change if a new renderer is made then.
  FrameRenderer(const Tracer& tracer, const EmitterSampler& emitters, const VisibilityData& data);
  ~FrameRenderer();
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  // The light of a frame, turned about the first environment's vertical axis (else +y). Seconds:
  // "light".
  FrameLight light(double degrees, const LightCutSettings& settings, Context& context) const;
  // Fills the film's picture (layer ""). Same seed, same pixels for any number of threads. Seconds:
  // "buffer", "merge", "shade": of the frame's time, shared out as threads spent theirs. Counts:
  // "frames", "pixels", "object_pixels", "vertices_merged", "merged_nodes", "evaluations",
  // "fine_chunks", "nonfinite" (pixels, left black). Throws Cancelled when the context is.
  void render(const FrameLight& light, const Camera& camera, const FrameSettings& settings,
              Film& film, Context& context);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia::relight
