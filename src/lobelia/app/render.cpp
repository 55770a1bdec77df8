#include "lobelia/app/render.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "lobelia/app/cut_export.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/gather_options.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/methods.h"
#include "lobelia/app/own_light.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/app/replay.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/unused_options.h"
#include "lobelia/app/vsgl_options.h"
#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

void requireLightFiles(const RenderOptions& options) {
  for (const auto& [name, file] : {std::pair{"--save-lights", options.saveLights},
                                   std::pair{"--load-lights", options.loadLights}}) {
    if (file.empty()) continue;
    if (!usesVirtualLights(options) || options.lights == "photon") {
      throw UsageError(
          fmt::format("{}: --lights {} has no virtual lights; use vpl, glossy, vsl or vsgl", name,
                      options.lights));
    }
    if (options.passes > 1) {
      throw UsageError(fmt::format("--passes draws new lights for every pass; leave out {}", name));
    }
  }
}

// The first frame's statistics are those of loading, too.
ExitCode renderUntilCancelled(const RenderOptions& options, const std::string& commandLine,
                              bool replayAll, Console& console, Context& context) {
  int64_t start = nanosecondsNow();
  const Scene scene = loadScene(options.scene, context);
  const std::vector<Frame> frames = planFrames(scene, options);
  if (frames.size() > 1 && !options.exportTrees.empty())
    throw UsageError("--export-trees is for one picture: name one camera");
  std::optional<Display> display;
  if (!options.display.empty()) display.emplace(options.display, "lobelia: " + scene.name, context);
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  if (emitters.empty()) context.warning("the scene has no light; the picture will be black");

  FrameRun run{scene, tracer, emitters, commandLine, display ? &*display : nullptr, {}, {}};
  if (!options.replay.empty()) {
    replay(frames.front(), run, replayAll, context);
    return signalExitCode();
  }
  renderFrame(frames.front(), start, run, context);
  for (size_t i = 1; i < frames.size() && !context.cancelled(); ++i) {
    start = nanosecondsNow();
    Context own(&console);
    own.seed = options.seed;
    own.statistics.setValue("embree_bytes", context.statistics.value("embree_bytes"));
    const SignalGuard signals(own);
    renderFrame(frames[i], start, run, own);
  }
  return signalExitCode();
}

}  // namespace

ExitCode render(const RenderOptions& options, const GlobalOptions& global,
                const std::string& commandLine) {
  requireMethod(options.lights, options.gather);
  requireLightFiles(options);
  requirePicture(options);
  requireLightLayers(options);
  requireGather(options);
  requireVsgl(options);
  requireOwnLight(options);
  requireFrames(options);
  requireReplay(options);
  requireCutExport(options);
  requireUsedResults(options);
  if (!options.display.empty()) parseViewerAddress(options.display);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.seed;
  for (const std::string& line : unusedOptions(options)) context.warning(line);
  const SignalGuard signals(context);
  try {
    return renderUntilCancelled(options, commandLine, global.verbose, console, context);
  } catch (const Cancelled&) {
    context.warning("stopped while loading the scene: there is no picture yet, none is written");
    return signalExitCode();
  }
}

}  // namespace lobelia::app
