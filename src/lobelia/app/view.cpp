#include "lobelia/app/view.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/view_script.h"
#include "lobelia/app/view_statistics.h"
#include "lobelia/base/parallel.h"
#include "lobelia/io/design.h"
#include "lobelia/relight/frame.h"

namespace lobelia::app {
namespace {

void requireView(const ViewOptions& options) {
  if (!options.headless) {
    throw UsageError(
        "this build draws without a window: add --headless, and -o FILE for the pictures");
  }
  if (options.rotateStep != 0 && options.render.frames == 0)
    throw UsageError("--rotate-step: say for how many frames with --frames N");
  if (!options.script.empty() && options.render.frames > 0)
    throw UsageError("--script and --frames: a script says itself how many frames there are");
  requirePicture(options.render);
  requireFrames(options.render);
}

bool lightsFromNearby(EmitterType type) {
  return type == EmitterType::point || type == EmitterType::spot || type == EmitterType::area ||
         type == EmitterType::projector || type == EmitterType::goniometric;
}

bool transmits(MaterialType type) {
  return type == MaterialType::dielectric || type == MaterialType::thinDielectric ||
         type == MaterialType::roughDielectric || type == MaterialType::diffuseTransmitter;
}

void warnOfMissing(const Scene& scene, Context& context) {
  size_t near = 0, clear = 0;
  for (const Emitter& emitter : scene.emitters) near += lightsFromNearby(emitter.type) ? 1 : 0;
  for (const Material& material : scene.materials) clear += transmits(material.type) ? 1 : 0;
  if (near == scene.emitters.size())
    context.warning("the scene has no light from infinity; add some with --environment or --sky");
  else if (near > 0)
    context.warning(
        fmt::format("{} of {} emitters are not at infinity: they are seen but light nothing", near,
                    scene.emitters.size()));
  if (clear > 0)
    context.warning(
        fmt::format("{} materials transmit light, of which only reflections are shown", clear));
}

relight::VisibilityData loadData(const std::string& file, const Scene& scene, Context& context) {
  const StageTimer timer(context, "data");
  return relight::load(file, scene);
}

// What the frames share.
class Frames {
 public:
  Frames(const ViewOptions& options, const std::string& commandLine, Context& context)
      : options_(options),
        commandLine_(commandLine),
        context_(context),
        script_(options.script.empty() ? std::vector<ScriptStep>() : readScript(options.script)),
        scene_(loadScene(options.render.scene, context)),
        plan_(planFrames(scene_, options.render, true)),
        data_(loadData(options.data, scene_, context)),
        tracer_(scene_, context),
        rotation_(options.rotate) {
    prepare();
  }

  void render() {
    if (script_.empty()) {
      for (const Frame& frame : plan_) {
        rotation_ = options_.rotate + options_.rotateStep * frame.number;
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
  void prepare() {
    warnOfMissing(scene_, context_);
    const StageTimer timer(context_, "prepare");
    renderer_.reset();
    emitters_.emplace(scene_, tracer_.bounds());
    renderer_.emplace(tracer_, *emitters_, data_);
  }

  void play() {
    using enum ScriptStep::Kind;
    const bool several = frameCount(script_) > 1;
    int number = 0;
    for (const ScriptStep& step : script_) {
      if (step.kind == rotate) rotation_ = step.degrees;
      if (step.kind == turn) rotation_ += step.degrees;
      if (step.kind == ScriptStep::Kind::camera) moveCamera(step.toWorld);
      if (step.kind == design || step.kind == environment) change(step);
      for (int i = 0; step.kind == frame && i < step.count; ++i, ++number)
        renderFrame({number, chooseCamera(scene_, options_.render),
                     several ? frameOptions(options_.render, number) : options_.render});
    }
  }
  // The one that pictures are seen by.
  void moveCamera(const Transform& toWorld) {
    const std::string name = chooseCamera(scene_, options_.render).name;
    const auto camera = std::find_if(scene_.cameras.begin(), scene_.cameras.end(),
                                     [&](const Camera& c) { return c.name == name; });
    camera->toWorld = toWorld;
    camera->path.clear();
  }
  void change(const ScriptStep& step) {
    io::ReadSettings settings;
    settings.strict = options_.render.scene.strict;
    if (step.kind == ScriptStep::Kind::design) {
      io::applyDesign(step.file, settings, scene_, context_);
    } else {
      settings.environment = step.file;
      io::applyEnvironment(scene_, settings);
    }
    for (const Finding& finding : validate(scene_))
      if (finding.severity == Severity::error) throw InputError(step.where, finding.message);
    relight::requireKnownSides(data_, scene_, step.where);
    prepare();
  }

  void renderFrame(const Frame& frame) {
    const int64_t start = nanosecondsNow();
    Film film = makeFilm(frame.camera, frame.options);
    film.layers.erase("direct");
    film.layers.erase("indirect");
    const relight::FrameLight light =
        renderer_->light(rotation_, {.nodeCount = options_.lightCut}, context_);
    renderer_->render(light, frame.camera,
                      {.spp = std::max(options_.render.spp, 1),
                       .refined = !options_.plainLobes,
                       .hideEmitters = scene_.hideEmitters},
                      film, context_);
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
  Scene scene_;
  const std::vector<Frame> plan_;
  const relight::VisibilityData data_;
  const Tracer tracer_;
  double rotation_;  // degrees
  std::optional<EmitterSampler> emitters_;
  std::optional<relight::FrameRenderer> renderer_;
  std::optional<ToneCurve> curve_;  // of all PNG files
};

}  // namespace

void addViewOptions(CLI::App& c, ViewOptions& o) {
  addSceneOptions(c, o.render.scene);
  c.add_option("--data", o.data, "Visibility of the scene, by `lobelia precompute`")
      ->type_name("FILE")
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
  try {
    const int64_t start = nanosecondsNow();
    Frames frames(options, commandLine, context);
    frames.render();
    context.statistics.addSeconds("total", static_cast<double>(nanosecondsNow() - start) * 1e-9);
    frames.writeStatistics();
  } catch (const Cancelled&) {
    context.warning("stopped; frames that were not finished are not written");
  }
  return signalExitCode();
}

}  // namespace lobelia::app
