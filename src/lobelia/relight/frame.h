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
  // Each thread's memory for what vertices see: beyond it they are forgotten and merged again,
  // which changes no pixel.
  size_t cacheBytes = size_t{64} << 20;
};

// Takes directions of light from infinity as the scene has it to the world, when it is turned about
// the first environment's vertical axis (else +y).
Mat4 turnOfLight(const Scene& scene, double degrees);

// What the frames of a scene share; keeps references.
class FrameRenderer {
 public:
  // data: of light from an environment, or this throws UsageError. emitters: of the scene of the
  // tracer; relight() when its emitters have changed.
  FrameRenderer(const Tracer& tracer, const EmitterSampler& emitters, const VisibilityData& data);
  ~FrameRenderer();
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  // Takes the light from the scene's emitters as they are now, of which `emitters` is made; keeps
  // all that depends on the data alone. Frames want a new light() then. Not during render().
  void relight(const EmitterSampler& emitters);

  // The light of a frame, turned about the first environment's vertical axis (else +y). Seconds:
  // "light".
  FrameLight light(double degrees, const LightCutSettings& settings, Context& context) const;
  // Fills the film's picture (layer "") and, where it has it, the layer "cost" (1 channel:
  // evaluations of lobes for directions, per sample). Same seed, same pixels for any number of
  // threads. Seconds: "buffer", "merge", "shade": of the frame's time, shared out as threads spent
  // theirs. Counts: "frames", "pixels", "object_pixels", "vertices_merged", "merged_nodes",
  // "evaluations", "fine_chunks", "nonfinite" (samples, left out of their pixels; the first such
  // pixel: noteNonFinitePixel()). Throws Cancelled when the context is.
  void render(const FrameLight& light, const Camera& camera, const FrameSettings& settings,
              Film& film, Context& context);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia::relight
