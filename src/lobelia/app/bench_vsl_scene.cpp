#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "lobelia/app/bench_studies.h"
#include "lobelia/app/bench_vsl.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kPixels = 4000;
constexpr int kWidth = 320;  // of pictures
constexpr uint64_t kReferenceSeed = 11, kPictureSeed = 12, kLightSeed = 13;
constexpr int kClampStepsAbove = 6;

BenchOptions withScene(BenchOptions options, const std::string& scene) {
  options.scene.scene = scene;
  return options;
}

}  // namespace

VslScene::VslScene(const BenchOptions& options, const VslSettings& settings,
                   const std::string& scene, Context& context)
    : settings_(settings),
      context_(context),
      scene_(withScene(options, scene), {.scene = scene, .pixels = kPixels, .width = kWidth},
             context),
      stem_(std::filesystem::path(scene).stem().string()) {}

void VslScene::progress(const std::string& what, double fraction) const {
  context_.progress(fmt::format("{}{}, {}", kBenchStage, scene_.name(), what), fraction);
}

BenchScene::Extent VslScene::extent() const {
  return settings_.folder.empty() ? BenchScene::Extent::pixels : BenchScene::Extent::picture;
}

void VslScene::setCommon(RenderOptions& options) const {
  options.gather = "mrcs";
  options.rows = settings_.rows;
  options.columns = settings_.columns;
  options.lightCount = settings_.lights;
  options.spp = settings_.eyeSamples;
}

const Reference& VslScene::reference() {
  if (!reference_)
    reference_ = pathReference(scene_, settings_.pathSamples, kReferenceSeed, context_);
  return *reference_;
}

// As many samples in all as the reference has, over all pixels, or an eighth of each pixel's.
const Film& VslScene::referencePicture() {
  if (picture_) return *picture_;
  const double share =
      static_cast<double>(scene_.pixelCount()) / static_cast<double>(scene_.pictureCount());
  const int spp = std::max(1, static_cast<int>(std::max(share, 0.125) * settings_.pathSamples));
  progress("picture of the reference", 0);
  picture_ = scene_.pathTraced(spp, kPictureSeed, BenchScene::Extent::picture);
  return *picture_;
}

ToneCurve VslScene::toneCurve() { return measureToneCurve(referencePicture(), {}); }

Comparison VslScene::compared(const Film& film) {
  return compare(film, reference().first, &reference().second);
}

const VslOutcome& VslScene::outcome(const VslMethod& method) {
  const auto found = outcomes_.find(method.key);
  if (found != outcomes_.end()) return found->second;
  reference();
  progress(method.label, 0);
  VslOutcome& outcome = outcomes_[method.key];
  if (context_.cancelled()) return outcome;
  const auto change = [&](RenderOptions& options) {
    setCommon(options);
    method.change(options);
  };
  const int64_t start = nanosecondsNow();
  outcome.film = scene_.virtualLights(change, kLightSeed, extent());
  outcome.seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
  if (!context_.cancelled()) outcome.error = compared(outcome.film);
  return outcome;
}

Comparison VslScene::measure(const BenchScene::Change& change) {
  reference();
  if (context_.cancelled()) return {};
  const Film film = scene_.virtualLights(
      [&](RenderOptions& options) {
        setCommon(options);
        change(options);
      },
      kLightSeed);
  return context_.cancelled() ? Comparison{} : compared(film);
}

const std::vector<VslScene::ClampPoint>& VslScene::clampCurve(const std::string& model) {
  std::vector<ClampPoint>& curve = curves_[model];
  if (!curve.empty()) return curve;
  const std::vector<double> clamps = clampValues(scene_.radius(), kClampStepsAbove);
  for (size_t i = 0; i < clamps.size() && !context_.cancelled(); ++i) {
    const auto change = [&](RenderOptions& options) {
      options.lights = model;
      options.clamp = clampText(clamps[i]);
    };
    reference();
    progress(model + " over clamp", static_cast<double>(i) / static_cast<double>(clamps.size()));
    const Comparison error = measure(change);
    if (!context_.cancelled()) curve.push_back({clamps[i], error.l2, error.meanRatio});
  }
  return curve;
}

std::string VslScene::bestClamp(const std::string& model) {
  double clamp = std::numeric_limits<double>::infinity(),
         least = std::numeric_limits<double>::infinity();
  for (const ClampPoint& point : clampCurve(model))
    if (point.l2 < least) least = point.l2, clamp = point.clamp;
  return clampText(clamp);
}

VslMethod VslScene::clamped(const std::string& model, const std::string& label) {
  const std::string clamp = bestClamp(model);
  const auto change = [=](RenderOptions& options) {
    options.lights = model;
    options.clamp = clamp;
  };
  return {model + "-clamped", label, change, clamp};
}

// "On the left we set the radius multiplier to 8 (4 for Disney Hall)", figure 8.
float VslScene::paperRadius() const { return scene_.name() == "hall" ? 4 : 8; }

VslMethod VslScene::asInThePaper() {
  const auto change = [factor = paperRadius()](RenderOptions& options) {
    options.lights = "vsl";
    options.radius = factor;
    options.sphereIndicator = "cosine";
    options.sphereSampling = "paper";
    options.nearField = 0;
  };
  return {"vsl-paper", "VSL as in the paper", change, ""};
}

VslMethod VslScene::ours() {
  return {"vsl", "VSL, our defaults", [](RenderOptions& options) { options.lights = "vsl"; }, ""};
}

}  // namespace lobelia::app
