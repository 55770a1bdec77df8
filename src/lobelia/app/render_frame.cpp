#include "lobelia/app/render_frame.h"

#include <fmt/format.h>

#include <memory>

#include "lobelia/app/checkpoint_file.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/gather_options.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/app/render_virtual_lights.h"
#include "lobelia/app/statistics_file.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

// The switch that replays the first pixel known to have lost a sample, or to hold such a value.
std::string replayHint(const Film& film, const Frame& frame, const Context& context) {
  size_t pixel = static_cast<size_t>(context.statistics.value("first_nonfinite_pixel"));
  for (size_t i = 0; i < film.pixelCount() && pixel == 0; ++i) {
    if (!isFinite(film.rgb(i))) pixel = i + 1;
  }
  if (pixel == 0) return "";
  const size_t width = static_cast<size_t>(film.width);
  const std::string which =
      frame.options.frames > 0 ? fmt::format("--frame {} ", frame.number) : std::string();
  return fmt::format("; {}--replay {},{} shows the first", which,
                     (pixel - 1) % width + static_cast<size_t>(film.x0),
                     (pixel - 1) / width + static_cast<size_t>(film.y0));
}

// Cuts as large as they may be that still miss --error.
void warnOfMissedErrors(const RenderOptions& options, Context& context) {
  constexpr double kMany = 0.05;  // of the clusters: fewer are creases and edges
  const double clusters = static_cast<double>(context.statistics.count("receiver_clusters"));
  const double missed = static_cast<double>(context.statistics.count("error_missed"));
  if (!(options.error > 0) || !(missed > kMany * clusters)) return;
  context.warning(fmt::format(
      "--error {} is missed by {:.0f} % of the clusters of receivers: their cuts have all "
      "of the {} nodes that they may have; {}",
      options.error, 100 * missed / clusters, cutSizeOf(options),
      options.cutSize > 0 ? "allow a larger --cut-size" : "more --spp reach it sooner"));
}

}  // namespace

void setMetadata(Film& film, const Scene& scene, const RenderOptions& options,
                 const std::string& commandLine, double seconds) {
  film.metadata["lobelia:version"] = kVersion;
  film.metadata["lobelia:command"] = commandLine;
  film.metadata["lobelia:seed"] = std::to_string(options.seed);
  film.metadata["lobelia:scene"] = scene.file.empty() ? scene.name : scene.file;
  film.metadata["lobelia:seconds"] = fmt::format("{:.3f}", seconds);
}

PathSettings pathSettings(const Scene& scene, const Camera& camera, const PixelSet& pixels,
                          int maxDepth, const RenderOptions& options) {
  PathSettings settings;
  settings.spp = options.spp > 0 ? options.spp : camera.spp > 0 ? camera.spp : 64;
  settings.maxDepth = maxDepth;
  settings.specularLimit = options.specularLimit;
  settings.component = componentOf(options);
  settings.timeLimit = options.timeLimit;
  settings.hideEmitters = scene.hideEmitters;
  settings.pixels = pixels;
  return settings;
}

bool usesVirtualLights(const RenderOptions& options) {
  return options.lights != "path" && options.lights != "light";
}

RenderedFilm renderFilm(const Frame& frame, FrameRun& run, Context& context) {
  const RenderOptions& options = frame.options;
  const Scene& scene = run.scene;
  const Camera& camera = frame.camera;
  const PixelSet pixels = choosePixels(camera, options);
  RenderedFilm out{makeFilm(camera, options), {}};
  const int maxDepth = options.maxDepth > 0 ? options.maxDepth : scene.maxDepth;
  addLightLayers(run.emitters.groups(), options, out.film);
  const std::unique_ptr<Checkpoints> checkpoints =
      openCheckpoint(scene, camera, maxDepth, options, context);
  if (run.display) run.display->begin(out.film);

  if (!usesVirtualLights(options)) {
    PathSettings settings = pathSettings(scene, camera, pixels, maxDepth, options);
    settings.checkpoints = checkpoints.get();
    settings.preview = run.display;
    const auto method = options.lights == "path" ? renderPath : renderLight;
    const StageTimer timer(context, "trace");
    method(run.tracer, run.emitters, camera, settings, out.film, context);
  } else {
    markPixels(out.film, pixels);
    out.report = renderVirtualLights(run.tracer, run.emitters, camera, pixels, maxDepth, options,
                                     out.film, context, checkpoints.get(), run.display,
                                     options.frames > 1 ? &run.lights : nullptr);
  }
  composePicture(out.film, options);
  return out;
}

void renderFrame(const Frame& frame, int64_t start, FrameRun& run, Context& context) {
  const RenderOptions& options = frame.options;
  const Scene& scene = run.scene;
  const int64_t renderStart = nanosecondsNow();
  auto [film, report] = renderFilm(frame, run, context);
  const int64_t end = nanosecondsNow();
  context.statistics.addSeconds("total", static_cast<double>(end - start) * 1e-9);

  if (const uint64_t bad = countNonFinite(film) + context.statistics.count("nonfinite"); bad > 0) {
    context.warning(fmt::format("{} non-finite values{}", bad, replayHint(film, frame, context)));
  }
  warnOfMissedErrors(options, context);
  setMetadata(film, scene, options, run.commandLine, context.statistics.seconds("total"));
  if (options.frames > 0) film.metadata["lobelia:frame"] = std::to_string(frame.number);
  writeOutputs(film, options, run.curve, context);
  if (!options.stats.empty()) writeStatistics(options.stats, options, scene, film, report, context);
  if (report.cuts) report.cuts->write(options, scene, film, run.commandLine, context);
  context.info(fmt::format("{:.2f} s rendering, {:.2f} s in all",
                           static_cast<double>(end - renderStart) * 1e-9,
                           context.statistics.seconds("total")));
  if (run.display) run.display->finish(film);
}

}  // namespace lobelia::app
