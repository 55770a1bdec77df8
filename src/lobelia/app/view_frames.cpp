#include "lobelia/app/view_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/app/studio/design_files.h"
#include "lobelia/app/studio/screenshot.h"
#include "lobelia/app/studio/script_edits.h"
#include "lobelia/app/studio/stage_of_files.h"
#include "lobelia/app/view_checks.h"
#include "lobelia/app/view_statistics.h"

namespace lobelia::app {
namespace {

using Kind = ScriptStep::Kind;

double turned(double degrees, double further) {
  return std::fmod(degrees + std::fmod(further, 360), 360);
}

Design turnedDesign(const Scene& scene, double degrees) {
  Design design = designOf(scene);
  design.rotation = std::fmod(degrees, 360);
  return design;
}

[[noreturn]] void throwUnknown(const char* what, const std::string& name,
                               const std::vector<std::string>& known, const Location& where) {
  throw InputError(where, fmt::format("{} '{}' is not known{}; there are {}", what, name,
                                      suggestion(name, known), fmt::join(known, ", ")));
}

}  // namespace

ViewFrames::ViewFrames(const ViewOptions& options, const std::string& commandLine, Context& context)
    : options_(options),
      commandLine_(commandLine),
      context_(context),
      script_(options.script.empty() ? std::vector<ScriptStep>() : readScript(options.script)),
      stage_(stageOf(options.render.scene, options.data, context)),
      plan_(planFrames(stage_.scene(), options.render, true)),
      history_(turnedDesign(stage_.scene(), options.rotate)),
      first_(history_.share()),
      maker_(stage_, first_, options.render.seed) {
  requireOwnFiles(options, script_);
  maker_.setEvenTruth();
  const ViewData& data = stage_.data();
  view_.method = data.method;
  requireBounce(options.bounce, stage_.transferPasses());
  requireTransferFrames(options, data, script_);
  warnOfMissing(data, stage_.scene(), context_);
  warnOfOptions(options, data, context_);
  if (stage_.hasCuts() && stage_.hasTransfer())
    context_.info(fmt::format("data of cuts and of transfer: frames are by {}, of the first --data",
                              viewMethodNames()[static_cast<size_t>(view_.method)]));
  view_.lightCut = options.lightCut;
  view_.refined = !options.plainLobes;
  view_.frameSpp = std::max(options.render.spp, 1);
  view_.cutsDepth = stage_.cutsDepth();
  view_.transferDepth = stage_.transferDepth();
  view_.areaPlaces = options.areaPlaces;
  view_.component = options.render.component;
  view_.bounce = options.bounce;
  view_.cropped = true;
  setCamera(plan_.front().camera);
}

void ViewFrames::render() {
  if (script_.empty()) {
    for (const Frame& frame : plan_) {
      const double rotation =
          turned(std::fmod(options_.rotate, 360),
                 std::fmod(options_.rotateStep, 360) * static_cast<double>(frame.number));
      if (rotation != history_.now().rotation)
        history_.edit("rotate", [&](Design& d) { d.rotation = rotation; });
      renderFrame(frame);
    }
  } else {
    for (const ScriptStep& step : script_) {
      play(step);
      history_.endEdit();
    }
  }
  if (context_.statistics.count("frames") > 0)  // in one go
    context_.info(fmt::format("{:.2f} frames per second", framesPerSecond(context_.statistics)));
  if (context_.statistics.count("nonfinite") > 0)
    context_.warning(fmt::format("{} values are not finite; they are left out",
                                 context_.statistics.count("nonfinite")));
}

void ViewFrames::writeStatistics() const {
  if (!options_.render.stats.empty())
    writeViewStatistics(options_, stage_.scene(), stage_.data(), context_);
}

void ViewFrames::play(const ScriptStep& step) {
  switch (step.kind) {
    case Kind::rotate:
      return history_.edit("rotate", [&](Design& d) { d.rotation = std::fmod(step.degrees, 360); });
    case Kind::turn:
      return history_.edit("turn",
                           [&](Design& d) { d.rotation = turned(d.rotation, step.degrees); });
    case Kind::camera:
      seenFrom_ = step.toWorld;
      return setCamera(scriptFrame(0).camera);
    case Kind::design:
    case Kind::environment:
      return load(step);
    case Kind::undo:
    case Kind::redo:
      if (step.kind == Kind::undo ? !history_.undo() : !history_.redo())
        throw InputError(step.where, step.kind == Kind::undo ? "there is nothing to undo"
                                                             : "there is nothing to do again");
      return show(step.where);
    case Kind::save:
      stage_.show(history_.share(), Stage::Use::paths, step.where, context_);
      stage_.save(step.file, *first_, view_.camera);
      return context_.info("wrote " + step.file);
    case Kind::method:
      return chooseMethod(step);
    case Kind::bounce:
      return chooseBounce(step);
    case Kind::truth:
      if (const std::string why = whyNoTruth(partOf(view_)); !why.empty())
        throw InputError(step.where, why);
      view_.truth = true;
      maker_.want(history_.share(), view_);
      for (int i = 0; i < step.count; ++i) truth_ = maker_.run(PictureMaker::Step::truth, context_);
      return;
    case Kind::falseColour:
      return chooseColours(step);
    case Kind::split:
      return splitAt(step);
    case Kind::screenshot:
      return screenshot(step);
    case Kind::frame:
      show(step.where);
      for (int i = 0; i < step.count; ++i) renderFrame(scriptFrame(number_++));
      return;
    default:
      return edit(step);
  }
}

// A design that the method cannot show fails where the script says it.
void ViewFrames::show(const Location& where) {
  stage_.show(history_.share(), useOf(view_.method, view_.white), where, context_);
}

void ViewFrames::load(const ScriptStep& step) {
  bool cameras = false;
  try {
    std::function<void(Design&)> change;
    if (step.kind == Kind::environment) {
      change = [image = readImageFile(step.file, false)](Design& d) { setEnvironment(d, image); };
    } else {
      const ReadDesign read =
          readDesign(history_.now(), step.file, options_.render.scene.strict, context_);
      cameras = read.parts.cameras;
      change = [design = read.design](Design& d) { d = *design; };
    }
    history_.edit(step.file, change);
  } catch (const InputError& e) {
    throw InputError(step.where, e.what());
  }
  show(step.where);
  stage_.requireValid(step.where);
  if (!cameras) return;
  seenFrom_.reset();
  setCamera(scriptFrame(0).camera);
}

void ViewFrames::edit(const ScriptStep& step) {
  try {
    history_.edit(editName(step), [&](Design& d) { applyEdit(step, d); });
  } catch (const InputError& e) {
    const std::string text = e.what();
    throw InputError(text.starts_with(toString(step.where)) ? Location{} : step.where, text);
  }
  show(step.where);
}

void ViewFrames::chooseMethod(const ScriptStep& step) {
  const std::optional<ViewMethod> method = viewMethod(step.words[0]);
  if (!method) throwUnknown("the method", step.words[0], viewMethodNames(), step.where);
  view_.method = *method;
  passes_ = step.count;
  view_.spp = PictureMaker::kMostTruth;  // the passes say when a picture is done
}

void ViewFrames::chooseBounce(const ScriptStep& step) {
  std::string why = whyNoBounce(step.count, stage_.transferPasses());
  if (step.count >= 0 && why.empty() && view_.method != ViewMethod::transfer)
    why = "this is of frames by transfer; add a line before it: method transfer";
  if (step.count >= 0 && why.empty() && view_.component != "all")
    why = fmt::format("the command line has --component {}; leave that out", view_.component);
  if (!why.empty()) throw InputError(step.where, fmt::format("bounce {}: {}", step.count, why));
  view_.bounce = step.count;
}

void ViewFrames::chooseColours(const ScriptStep& step) {
  const auto& names = shownNames();
  const auto at = std::find(names.begin(), names.end(), step.words[0]);
  if (at == names.end()) throwUnknown("the false colour", step.words[0], names, step.where);
  display_.shown = static_cast<Shown>(at - names.begin());
  display_.fixedRange = step.words.size() == 3;
  if (step.words.size() == 2)
    throw InputError(step.where, "a range is two numbers: false-colour KIND LEAST MOST");
  if (display_.fixedRange) {
    display_.least = static_cast<float>(scriptNumber(step.words[1], step.where));
    display_.most = static_cast<float>(scriptNumber(step.words[2], step.where));
  }
  view_.cost = display_.shown == Shown::cost;
  view_.white = display_.shown == Shown::illuminance;
}

void ViewFrames::splitAt(const ScriptStep& step) {
  if (step.words[0] == "off") {
    display_.split = -1;
    return;
  }
  const double share = scriptNumber(step.words[0], step.where);
  if (!(share >= 0 && share <= 1))
    throw InputError(step.where, fmt::format("split {}: a share of the width, from 0 to 1", share));
  display_.split = static_cast<float>(share);
}

void ViewFrames::screenshot(const ScriptStep& step) const {
  if (!picture_)
    throw InputError(step.where, "there is no picture yet; add a line before it: frame");
  if (display_.split >= 0 && !truth_)
    throw InputError(step.where,
                     "there is no truth of this picture to split it with; add a line after its "
                     "frame: truth 16");
  if (const std::string why = whyNoTruth(picture_->part); display_.split >= 0 && !why.empty())
    throw InputError(step.where, why);
  if (const std::string why = whyNotShown(*picture_, truth_.get(), display_.shown); !why.empty())
    throw InputError(step.where, why);
  DisplaySettings settings = display_;
  settings.curve = curve_ ? *curve_ : measureToneCurve(picture_->film, {});
  settings.exposure = curve_ ? 0 : options_.render.exposure;
  try {
    writeScreenshot(step.file, *picture_, truth_.get(), settings);
  } catch (const UsageError& e) {
    throw InputError(step.where, e.what());
  }
  context_.info("wrote " + step.file);
}

Frame ViewFrames::scriptFrame(int number) const {
  Scene cameras;
  cameras.cameras = history_.now().cameras;
  Frame frame{number, chooseCamera(cameras, options_.render), options_.render};
  if (seenFrom_) frame.camera.toWorld = *seenFrom_;
  frame.camera.path.clear();
  for (std::string& file : frame.options.outputs)
    if (frameCount(script_) > 1 || file.find('%') != std::string::npos)
      file = frameFile(file, number);
  return frame;
}

void ViewFrames::setCamera(const Camera& film) {
  view_.camera = film;
  view_.width = film.width, view_.height = film.height;
}

std::shared_ptr<Picture> ViewFrames::makePicture() {
  using Step = PictureMaker::Step;
  if (inOneGo(view_.method)) return maker_.run(Step::frame, context_);
  maker_.restart();
  std::shared_ptr<Picture> picture;
  for (int i = 0; i < passes_; ++i) picture = maker_.run(Step::pass, context_);
  return picture;
}

void ViewFrames::renderFrame(const Frame& frame) {
  const int64_t start = nanosecondsNow();
  setCamera(frame.camera);
  const std::shared_ptr<Picture> truth =
      maker_.truthStands(history_.share(), view_) ? truth_ : nullptr;
  maker_.want(history_.share(), view_);
  truth_ = truth;
  picture_ = makePicture();
  const double seconds = static_cast<double>(nanosecondsNow() - start) * 1e-9;
  setMetadata(picture_->film, stage_.scene(), frame.options, commandLine_, seconds);
  if (options_.render.frames > 0 || frameCount(script_) > 1)
    picture_->film.metadata["lobelia:frame"] = std::to_string(frame.number);
  Film film = picture_->film;
  for (const char* layer : {"cost", "samples", "error"}) film.layers.erase(layer);
  // White surfaces would set another exposure than the pictures before and after them.
  std::optional<ToneCurve> whiteCurve;
  writeOutputs(film, frame.options, view_.white ? whiteCurve : curve_, context_);
}

}  // namespace lobelia::app
