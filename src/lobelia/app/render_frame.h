// The life of one picture: its film, rendered by a method, in files.
#pragma once

#include <optional>
#include <string>

#include "lobelia/app/display.h"
#include "lobelia/app/frames.h"
#include "lobelia/app/render_virtual_lights.h"
#include "lobelia/film/film.h"
#include "lobelia/lights/light_pass.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia::app {

// What the frames of a run share.
struct FrameRun {
  const Scene& scene;
  const Tracer& tracer;
  const EmitterSampler& emitters;
  const std::string& commandLine;
  Display* display = nullptr;           // null: nobody looks on
  std::optional<ToneCurve> curve;       // of all PNG files
  std::optional<VirtualLights> lights;  // the first set
};

// What a picture file says of its making.
void setMetadata(Film& film, const Scene& scene, const RenderOptions& options,
                 const std::string& commandLine, double seconds);
// Of the path and the light tracer.
PathSettings pathSettings(const Scene& scene, const Camera& camera, const PixelSet& pixels,
                          int maxDepth, const RenderOptions& options);
bool usesVirtualLights(const RenderOptions& options);
struct RenderedFilm {
  Film film;
  VirtualLightReport report;
};
// The picture, in no file yet. When cancelled, what there is.
RenderedFilm renderFilm(const Frame& frame, FrameRun& run, Context& context);
// The same and its files. start: when work for this frame began (its statistics' total). When
// cancelled, what there is gets written.
void renderFrame(const Frame& frame, int64_t start, FrameRun& run, Context& context);

}  // namespace lobelia::app
