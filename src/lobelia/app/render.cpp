#include "lobelia/app/render.h"

#include <fmt/format.h>

#include <utility>

#include "lobelia/app/checkpoint_file.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/methods.h"
#include "lobelia/app/render_virtual_lights.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/statistics_file.h"
#include "lobelia/base/parallel.h"
#include "lobelia/version.h"

namespace lobelia::app {
namespace {

PathSettings pathSettings(const Scene& scene, const Camera& camera, const PixelSet& pixels,
                          int maxDepth, const RenderOptions& options) {
  PathSettings settings;
  settings.spp = options.spp > 0 ? options.spp : camera.spp > 0 ? camera.spp : 64;
  settings.maxDepth = maxDepth;
  settings.specularLimit = options.specularLimit;
  settings.component = options.component == "direct"     ? Component::direct
                       : options.component == "indirect" ? Component::indirect
                                                         : Component::all;
  settings.timeLimit = options.timeLimit;
  settings.hideEmitters = scene.hideEmitters;
  settings.pixels = pixels;
  return settings;
}

void setMetadata(Film& film, const Scene& scene, const RenderOptions& options,
                 const std::string& commandLine, double seconds) {
  film.metadata["lobelia:version"] = kVersion;
  film.metadata["lobelia:command"] = commandLine;
  film.metadata["lobelia:seed"] = std::to_string(options.seed);
  film.metadata["lobelia:scene"] = scene.file.empty() ? scene.name : scene.file;
  film.metadata["lobelia:seconds"] = fmt::format("{:.3f}", seconds);
}

bool usesVirtualLights(const RenderOptions& options) {
  return options.lights != "path" && options.lights != "light";
}

void requireLightFiles(const RenderOptions& options) {
  for (const auto& [name, file] : {std::pair{"--save-lights", options.saveLights},
                                   std::pair{"--load-lights", options.loadLights}}) {
    if (file.empty()) continue;
    if (!usesVirtualLights(options)) {
      throw UsageError(fmt::format("{}: --lights {} has no virtual lights; use vpl or glossy", name,
                                   options.lights));
    }
    if (options.passes > 1) {
      throw UsageError(fmt::format("--passes draws new lights for every pass; leave out {}", name));
    }
  }
}

ExitCode renderUntilCancelled(const RenderOptions& options, const std::string& commandLine,
                              Context& context) {
  const int64_t start = nanosecondsNow();
  const Scene scene = loadScene(options.scene, context);
  const Camera camera = chooseCamera(scene, options);
  const PixelSet pixels = choosePixels(camera, options);
  Film film = makeFilm(camera, options);
  const int maxDepth = options.maxDepth > 0 ? options.maxDepth : scene.maxDepth;
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  if (emitters.empty()) context.warning("the scene has no light; the picture will be black");

  const std::unique_ptr<Checkpoints> checkpoints =
      openCheckpoint(scene, camera, maxDepth, options, context);
  VirtualLightReport report;
  const int64_t renderStart = nanosecondsNow();
  if (!usesVirtualLights(options)) {
    PathSettings settings = pathSettings(scene, camera, pixels, maxDepth, options);
    settings.checkpoints = checkpoints.get();
    const auto method = options.lights == "path" ? renderPath : renderLight;
    {
      const StageTimer timer(context, "trace");
      method(tracer, emitters, camera, settings, film, context);
    }
    composePicture(film, options);
  } else {
    markPixels(film, pixels);
    report = renderVirtualLights(tracer, emitters, camera, pixels, maxDepth, options, film, context,
                                 checkpoints.get());
    composePicture(film, options);
  }
  context.statistics.addSeconds("total", static_cast<double>(nanosecondsNow() - start) * 1e-9);

  if (const uint64_t bad = countNonFinite(film) + context.statistics.count("nonfinite"); bad > 0) {
    context.warning(fmt::format("{} non-finite values", bad));
  }
  setMetadata(film, scene, options, commandLine, context.statistics.seconds("total"));
  writeOutputs(film, options, context);
  if (!options.stats.empty()) writeStatistics(options.stats, options, scene, film, report, context);
  context.info(fmt::format("{:.2f} s rendering, {:.2f} s in all",
                           static_cast<double>(nanosecondsNow() - renderStart) * 1e-9,
                           context.statistics.seconds("total")));
  return signalExitCode();
}

}  // namespace

ExitCode render(const RenderOptions& options, const GlobalOptions& global,
                const std::string& commandLine) {
  requireMethod(options.lights, options.gather);
  requireLightFiles(options);
  requireOutputs(options);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.seed;
  const SignalGuard signals(context);
  try {
    return renderUntilCancelled(options, commandLine, context);
  } catch (const Cancelled&) {
    context.warning("stopped while loading the scene: there is no picture yet, none is written");
    return signalExitCode();
  }
}

}  // namespace lobelia::app
