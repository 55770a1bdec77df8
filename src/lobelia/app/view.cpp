#include "lobelia/app/view.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/view_frames.h"
#include "lobelia/app/viewer/window_run.h"
#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

void requireView(const ViewOptions& options) {
  const RenderOptions& render = options.render;
  if (!options.uiScript.empty())
    throw UsageError(
        "--ui-script plays at the window, which --headless has not; --script is for "
        "frames without one");
  if (options.data.empty() && options.script.empty())
    throw UsageError(
        "--data is required: what `lobelia precompute` made of the scene; only scripts that choose "
        "a method of `render` go without");
  if (!options.script.empty() &&
      (options.rotateStep != 0 || render.frames > 0 || render.turntable || !render.frame.empty()))
    throw UsageError(
        "--frames, --frame, --turntable and --rotate-step do not go with --script: it says itself "
        "what the frames are");
  if (options.rotateStep != 0 && options.render.frames == 0)
    throw UsageError("--rotate-step: say for how many frames with --frames N");
  std::vector<std::string> written = render.outputs;
  written.push_back(render.stats);
  std::vector<std::string> read = options.data;
  for (const std::string& file :
       {options.script, render.scene.scene, render.scene.design, render.scene.environment})
    read.push_back(file);
  requireNoInput(written, read);
  requirePicture(options.render);
  requireFrames(options.render);
}

}  // namespace

void addViewOptions(CLI::App& c, ViewOptions& o) {
  addSceneOptions(c, o.render.scene);
  c.add_option(
       "--data", o.data,
       "What `lobelia precompute` made of the scene, needed for cuts and transfer; several: "
       "cuts of light from infinity, cuts of local lights, transfer; the first says which "
       "is shown")
      ->type_name("FILE")
      ->allow_extra_args(false);
  c.add_option("--ui-script", o.uiScript,
               "Plays mouse and keys at the window, then closes it (docs/manual.md)")
      ->type_name("FILE");
  c.add_option("--script", o.script, "Camera moves, edits and frames, one a line (docs/manual.md)")
      ->type_name("FILE");
  c.add_flag("--headless", o.headless, "Draw without a window");
  c.add_option("-o,--output", o.render.outputs,
               "Picture to write: .exr (linear), .png (tone-mapped)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  c.add_option("--spp", o.render.spp,
               "Samples per pixel by the camera's filter; default: one, through its middle")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  addPictureOptions(c, o.render);
  c.add_option("--light-cut", o.lightCut, "Nodes of the light's cut, at most")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 15))
      ->capture_default_str();
  c.add_option("--area-places", o.areaPlaces,
               "Places of each area emitter from which it lights a pixel")
      ->type_name("N")
      ->check(integerRange(1, 1024))
      ->capture_default_str();
  c.add_option("--component", o.render.component,
               "Which light of transfer, or of cuts for local lights: all, direct or indirect")
      ->type_name("WHICH")
      ->check(CLI::IsMember({"all", "direct", "indirect"}))
      ->capture_default_str();
  c.add_option("--bounce", o.bounce,
               "Of transfer: light of so many reflections at other surfaces alone; 0: direct light")
      ->type_name("N")
      ->check(integerRange(0, 64))
      ->excludes("--component");
  c.add_option("--rotate", o.rotate,
               "Turn the light from infinity about the environment's vertical axis")
      ->type_name("DEGREES")
      ->check(finiteNumber(-HUGE_VAL));
  c.add_option("--rotate-step", o.rotateStep, "Turn it so much further with every frame")
      ->type_name("DEGREES")
      ->check(finiteNumber(-HUGE_VAL));
  c.add_flag("--plain-lobes", o.plainLobes,
             "Narrow lobes get no finer light than the cut has: the paper's way");
  c.add_option("--seed", o.render.seed, "Seed of all randomness")
      ->type_name("N")
      ->check(seedNumber())
      ->capture_default_str();
  c.add_option("--stats", o.render.stats, "Write statistics as JSON")->type_name("FILE");
  c.add_option("--exposure", o.render.exposure, "Stops added to the PNG's automatic exposure")
      ->type_name("STOPS")
      ->check(finiteNumber(-100, 100));
}

ExitCode view(const ViewOptions& options, const GlobalOptions& global,
              const std::string& commandLine) {
  if (!options.headless) return runWindow(options, global, commandLine);
  requireView(options);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.render.seed;
  const SignalGuard signals(context);
  const int64_t start = nanosecondsNow();
  std::optional<ViewFrames> frames;
  try {
    frames.emplace(options, commandLine, context);
    frames->render();
  } catch (const Cancelled&) {
    context.warning("stopped; frames that were not finished are not written");
  }
  context.statistics.addSeconds("total", static_cast<double>(nanosecondsNow() - start) * 1e-9);
  if (frames) frames->writeStatistics();
  return signalExitCode();
}

}  // namespace lobelia::app
