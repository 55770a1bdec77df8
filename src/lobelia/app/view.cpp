#include "lobelia/app/view.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lobelia/app/cut_frames.h"
#include "lobelia/app/edited_scene.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/view_script.h"
#include "lobelia/app/view_statistics.h"
#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

void requireView(const ViewOptions& options) {
  if (!options.headless) {
    throw UsageError(
        "this build draws without a window: add --headless, and -o FILE for the pictures");
  }
  const RenderOptions& render = options.render;
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

// What the frames share.
class Frames {
 public:
  Frames(const ViewOptions& options, const std::string& commandLine, Context& context)
      : options_(options),
        commandLine_(commandLine),
        context_(context),
        script_(options.script.empty() ? std::vector<ScriptStep>() : readScript(options.script)),
        edited_(loadScene(options.render.scene, context), options.render.scene.strict),
        scene_(edited_.scene()),
        geometry_(relight::geometryHash(scene_)),
        plan_(planFrames(scene_, options.render, true)),
        data_(loadCutData(options.data, scene_, context)),
        tracer_(scene_, context),
        frames_(tracer_, data_),
        rotation_(options.rotate) {
    warnOfMissing(data_, scene_, context_);
    frames_.relight(context_);
  }

  void render() {
    if (script_.empty()) {
      for (const Frame& frame : plan_) {
        rotation_ = std::fmod(
            std::fmod(options_.rotate, 360) + std::fmod(options_.rotateStep, 360) * frame.number,
            360);
        renderFrame(frame);
      }
    } else {
      play();
    }
    context_.info(fmt::format("{:.2f} frames per second", framesPerSecond(context_.statistics)));
    if (context_.statistics.count("nonfinite") > 0)
      context_.warning(fmt::format("{} values are not finite; they are left out",
                                   context_.statistics.count("nonfinite")));
  }
  void writeStatistics() const {
    if (!options_.render.stats.empty()) writeViewStatistics(options_, scene_, data_, context_);
  }

 private:
  void play() {
    int number = 0;
    for (const ScriptStep& step : script_) {
      switch (step.kind) {
        case ScriptStep::Kind::rotate:
          rotation_ = std::fmod(step.degrees, 360);
          break;
        case ScriptStep::Kind::turn:
          rotation_ = std::fmod(rotation_ + std::fmod(step.degrees, 360), 360);
          break;
        case ScriptStep::Kind::camera:
          view_ = step.toWorld;
          break;
        case ScriptStep::Kind::design:
        case ScriptStep::Kind::environment:
          change(step);
          break;
        case ScriptStep::Kind::frame:
          for (int i = 0; i < step.count; ++i) renderFrame(scriptFrame(number++));
          break;
      }
    }
  }
  Frame scriptFrame(int number) const {
    Frame frame{number, chooseCamera(scene_, options_.render), options_.render};
    if (view_) frame.camera.toWorld = *view_;
    frame.camera.path.clear();
    for (std::string& file : frame.options.outputs)
      if (frameCount(script_) > 1 || file.find('%') != std::string::npos)
        file = frameFile(file, number);
    return frame;
  }
  void change(const ScriptStep& step) {
    const io::DesignParts parts = edited_.change(step, context_);
    if (parts.cameras) view_.reset();
    if (parts.materials) {
      requireKnownSides(data_, scene_, step.where);
      if (relight::geometryHash(scene_) != geometry_)
        throw InputError(step.where,
                         "this changes which parts of surfaces are masked out, which "
                         "the visibility has to know; make a scene with it and "
                         "precompute that");
    }
    frames_.relight(context_);  // emitters' images may have moved, whatever the edit is of
  }

  void renderFrame(const Frame& frame) {
    const int64_t start = nanosecondsNow();
    Film film = makeFilm(frame.camera, frame.options);
    film.layers.erase("direct");
    film.layers.erase("indirect");
    frames_.render({.spp = std::max(options_.render.spp, 1),
                    .lightCut = options_.lightCut,
                    .rotation = rotation_,
                    .plainLobes = options_.plainLobes,
                    .areaPlaces = options_.areaPlaces,
                    .component = options_.render.component},
                   frame.camera, film, context_);
    const double seconds = static_cast<double>(nanosecondsNow() - start) * 1e-9;
    setMetadata(film, scene_, frame.options, commandLine_, seconds);
    if (options_.render.frames > 0 || frameCount(script_) > 1)
      film.metadata["lobelia:frame"] = std::to_string(frame.number);
    writeOutputs(film, frame.options, curve_, context_);
  }

  const ViewOptions& options_;
  const std::string& commandLine_;
  Context& context_;
  const std::vector<ScriptStep> script_;
  EditedScene edited_;
  const Scene& scene_;
  const uint64_t geometry_;
  const std::vector<Frame> plan_;
  const CutData data_;
  const Tracer tracer_;
  CutFrames frames_;
  double rotation_;                 // degrees
  std::optional<Transform> view_;   // that a script gave the camera
  std::optional<ToneCurve> curve_;  // of all PNG files
};

}  // namespace

void addViewOptions(CLI::App& c, ViewOptions& o) {
  addSceneOptions(c, o.render.scene);
  c.add_option(
       "--data", o.data,
       "Visibility of the scene, by `lobelia precompute`; twice: of light from infinity and "
       "of local lights")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->required();
  c.add_option("--script", o.script, "Camera moves, edits and frames, one a line (docs/manual.md)")
      ->type_name("FILE");
  c.add_flag("--headless", o.headless, "Draw without a window (the only way so far)");
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
               "Which light of data of local lights: all, direct or indirect")
      ->type_name("WHICH")
      ->check(CLI::IsMember({"all", "direct", "indirect"}))
      ->capture_default_str();
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
  requireView(options);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.render.seed;
  const SignalGuard signals(context);
  const int64_t start = nanosecondsNow();
  std::optional<Frames> frames;
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
