#include "lobelia/app/studio/picture_maker.h"

#include <algorithm>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/base/random.h"

namespace lobelia::app {
namespace {

constexpr int kLookDivisor = 4;     // of each side
constexpr int kLookLeast = 64;      // smaller pictures are soon there
constexpr double kSlowFrame = 0.5;  // seconds: frames that take as long want a look before
constexpr int kMostSamples = 16;    // of a pass
constexpr uint64_t kTruthStream = 0x7475746874ull, kLookStream = 0x6c6f6f6bull;

// Passes grow: a first one is soon there, later ones cost less around them.
int samplesOf(const PassMean& mean, int most) {
  const int wanted = std::clamp(mean.samples() / 2, 1, kMostSamples);
  return std::max(std::min(wanted, most - mean.samples()), 1);
}

bool mayBeSmaller(const ViewState& view) {
  return !view.cropped && std::min(view.width, view.height) >= kLookLeast;
}

double secondsSince(int64_t start) { return static_cast<double>(nanosecondsNow() - start) * 1e-9; }

std::vector<std::pair<std::string, double>> partsOf(const Statistics& statistics) {
  std::vector<std::pair<std::string, double>> parts;
  for (const char* stage :
       {"prepare", "accel", "light", "buffer", "cut", "merge", "direct", "shade", "trace",
        "receivers", "lights", "trees", "traverse", "visibility"})
    if (const double seconds = statistics.seconds(stage); seconds > 0)
      parts.emplace_back(stage, seconds);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return parts;
}

}  // namespace

void PictureMaker::want(std::shared_ptr<const Design> design, const ViewState& view) {
  const bool sameDesign = design == design_;
  if (!sameDesign || !samePicture(view, view_)) restart();
  if (!sameDesign || !sameTruth(view, view_)) {
    truth_.clear();
    truthGivenUp_ = false;
    truthSeconds_ = 0;
  }
  design_ = std::move(design);
  view_ = view;
}

void PictureMaker::restart() {
  mean_.clear();
  looked_ = started_ = givenUp_ = false;
  pictureSeconds_ = 0;
}

bool PictureMaker::isDone() const {
  if (givenUp_ || !design_ || view_.width < 1 || view_.height < 1) return true;
  return inOneGo(view_.method) ? started_ : started_ && mean_.samples() >= view_.spp;
}

PictureMaker::Step PictureMaker::next() const {
  if (!design_ || view_.width < 1 || view_.height < 1) return Step::none;
  const bool truth = view_.truth && !truthGivenUp_ && truth_.samples() < kMostTruth;
  // Both at once share the time.
  if (isDone()) return truth ? Step::truth : Step::none;
  if (truth && mean_.passes() > 0 && truthSeconds_ < pictureSeconds_) return Step::truth;
  if (inOneGo(view_.method))
    return !looked_ && frameSeconds_ > kSlowFrame && mayBeSmaller(view_) ? Step::look : Step::frame;
  return started_ ? Step::pass : Step::look;
}

void PictureMaker::giveUp(Step step) { (step == Step::truth ? truthGivenUp_ : givenUp_) = true; }

void PictureMaker::show(ViewMethod method, Context& context) {
  if (method == ViewMethod::cuts) return showCuts(context);
  stage_.show(design_, useOf(method, view_.white), {}, context);
}

void PictureMaker::showCuts(Context& context) {
  const Stage::Use use = useOf(ViewMethod::cuts, view_.white);
  try {
    stage_.show(design_, use, {}, context);
    accepted_ = design_;
    refusal_.clear();
  } catch (const InputError& e) {
    if (!stage_.hasCuts()) throw;
    if (refusal_ != e.what())
      context.warning(std::string(e.what()) + "; cuts go on without, other methods show it");
    refusal_ = e.what();
    stage_.show(accepted_, use, {}, context);
  }
}

std::shared_ptr<Picture> PictureMaker::run(Step step, Context& context) {
  const int64_t start = nanosecondsNow();
  std::shared_ptr<Picture> picture;
  context.seed = seed_;
  const bool whole = inOneGo(view_.method);
  show(step == Step::truth ? ViewMethod::path : view_.method, context);
  switch (step) {
    case Step::none:
      return nullptr;
    case Step::frame:
      try {
        picture = frame(view_, context);
      } catch (const Cancelled&) {
        frameSeconds_ = std::max(frameSeconds_, secondsSince(start));
        throw;
      }
      frameSeconds_ = secondsSince(start);
      break;
    case Step::look:
      picture = look(context);
      break;
    case Step::pass:
      context.seed = hashCombine(seed_, static_cast<uint64_t>(mean_.passes()));
      picture = pass(view_.method, mean_, context);
      break;
    case Step::truth:
      context.seed =
          hashCombine(hashCombine(seed_, kTruthStream), static_cast<uint64_t>(truth_.passes()));
      picture = pass(ViewMethod::path, truth_, context);
      break;
  }
  if (step == Step::look) looked_ = true;
  if (step != Step::truth && !(step == Step::look && whole)) started_ = true;
  picture->seconds = secondsSince(start);
  double& all = step == Step::truth ? truthSeconds_ : pictureSeconds_;
  all += picture->seconds;
  picture->secondsInAll = all;
  picture->white = view_.white;
  picture->parts = partsOf(context.statistics);
  setMetadata(picture->film, stage_.scene(), {}, "view", all);
  picture->film.metadata["lobelia:seed"] = std::to_string(seed_);
  picture->film.metadata["lobelia:method"] = picture->method;
  picture->film.metadata["lobelia:samples"] = std::to_string(picture->samples);
  return picture;
}

std::shared_ptr<Picture> PictureMaker::frame(const ViewState& view, Context& context) {
  const Camera camera = viewCamera(view);
  auto picture = std::make_shared<Picture>();
  picture->film = makeFilm(camera, {});
  picture->film.layers.erase("direct");
  picture->film.layers.erase("indirect");
  picture->method = viewMethodNames()[static_cast<size_t>(view.method)];
  picture->part = partOf(view);
  if (view.method == ViewMethod::transfer) {
    stage_.renderTransfer(camera,
                          {.spp = view.frameSpp,
                           .rotation = design_->rotation,
                           .component = view.component,
                           .bounce = view.bounce},
                          picture->film, context);
    return picture;
  }
  if (view.cost) picture->film.addLayer("cost", 1);
  stage_.renderCuts(camera,
                    {.spp = view.frameSpp,
                     .lightCut = view.lightCut,
                     .rotation = design_->rotation,
                     .plainLobes = !view.refined,
                     .areaPlaces = view.areaPlaces,
                     .component = view.component},
                    picture->film, context);
  return picture;
}

std::shared_ptr<Picture> PictureMaker::look(Context& context) {
  if (!mayBeSmaller(view_)) {
    context.seed = hashCombine(seed_, 0);
    return pass(view_.method, mean_, context);
  }
  ViewState small = view_;
  small.width /= kLookDivisor, small.height /= kLookDivisor, small.cropped = false;
  context.seed = hashCombine(seed_, kLookStream);
  std::shared_ptr<Picture> picture;
  if (inOneGo(view_.method)) {
    picture = frame(small, context);
  } else {
    picture = std::make_shared<Picture>();
    PassMean mean;
    mean.add(stage_.renderPass(viewCamera(small), passOptions(small, view_.method, 1), context), 1);
    picture->film = mean.film();
    picture->method = viewMethodNames()[static_cast<size_t>(view_.method)];
  }
  picture->quick = true;
  return picture;
}

std::shared_ptr<Picture> PictureMaker::pass(ViewMethod method, PassMean& mean, Context& context) {
  const bool truth = &mean == &truth_;
  const int samples = truth && evenTruth_ ? 1 : samplesOf(mean, truth ? kMostTruth : view_.spp);
  mean.add(stage_.renderPass(viewCamera(view_), passOptions(view_, method, samples), context),
           samples);
  auto picture = std::make_shared<Picture>();
  picture->film = mean.film();
  picture->method = viewMethodNames()[static_cast<size_t>(method)];
  picture->passes = mean.passes(), picture->samples = mean.samples();
  picture->relativeError = mean.relativeError();
  return picture;
}

}  // namespace lobelia::app
