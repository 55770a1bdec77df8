// A frame of the interactive renderer under local lights: their direct light by shadow rays and one
// bounce of indirect light from samples on the scene's surfaces, whose visibility is known by cuts
// [P004 sections 3, 4.2]. Lights, materials and the view may change with every frame.
//
// Deviations: shadows are traced, for pixels and samples alike, where the paper looks into cube
// maps; each tile selects its own light cut (tile_cut.h); and lobes too smooth for samples, mirrors
// above all, are followed by a ray that shows what it meets in the light of one bounce.
#pragma once

#include <memory>

#include "lobelia/film/film.h"
#include "lobelia/path/emitter_sampling.h"
#include "lobelia/relight/surface_light.h"
#include "lobelia/relight/visibility_data.h"

namespace lobelia::relight {

struct LocalSettings {
  int spp = 1;             // 1: through the pixel's middle, else by the camera's filter
  size_t nodeCount = 512;  // of a tile's light cut, at most
  int areaPlaces = 4;      // of each area emitter that light a pixel (or a sample), by shadow rays
  bool direct = true;      // off: bounced light alone
  bool bounced = true;     // off: direct light alone
  bool hideEmitters = false;
  // Adds to the film's picture, which has emission and what lies behind all surfaces already, in
  // mirrors, too; not through panes.
  bool add = false;
  Mat4 toScene{};  // takes directions of the world to light from infinity as the scene has it
  size_t cacheBytes = size_t{64} << 20;  // each thread's, for what vertices see
};

// What the frames of a scene share; keeps references.
class LocalRenderer {
 public:
  // data: of light from surfaces, or this throws UsageError. emitters: of the scene of the tracer;
  // relight() when its emitters have changed.
  LocalRenderer(const Tracer& tracer, const EmitterSampler& emitters, const VisibilityData& data);
  ~LocalRenderer();
  LocalRenderer(const LocalRenderer&) = delete;
  LocalRenderer& operator=(const LocalRenderer&) = delete;

  // Takes the scene's emitters as they are now, of which `emitters` is made. Not during render().
  void relight(const EmitterSampler& emitters);
  bool hasLight() const;  // are there local emitters?

  // The light of a frame at the samples, by the scene's materials as they are now. Seconds:
  // "light". Counts: "light_rays".
  SurfaceLight light(const LocalSettings& settings, Context& context) const;
  // Fills the film's picture (layer "") and, where it has it, the layer "cost" (1 channel:
  // evaluations of lobes for nodes, per sample), or adds to them. light: of no meaning where
  // settings.bounced is off. Same seed, same pixels for any number of
  // threads. Seconds: "buffer", "cut", "merge", "direct", "shade": of the frame's time, shared out
  // as threads spent theirs. Counts: "frames", "pixels", "object_pixels", "vertices_merged",
  // "merged_nodes", "cut_nodes" (summed over pixels), "evaluations", "shadow_rays", "mirror_rays",
  // "nonfinite" (as of FrameRenderer). Throws Cancelled when the context is.
  void render(const SurfaceLight& light, const Camera& camera, const LocalSettings& settings,
              Film& film, Context& context);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia::relight
