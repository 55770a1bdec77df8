#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "lobelia/app/bench_sglc.h"
#include "lobelia/app/bench_spent.h"
#include "lobelia/app/bench_studies.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kPixels = 400;
constexpr int kWidth = 320;
constexpr uint64_t kSeed = 41;  // of receivers and lights alike: methods differ in nothing else
// Directional lights of an environment, of all lights: [P000] has 50,000 beside 3.2 million.
constexpr uint64_t kEnvironmentShare = 64, kLeastEnvironmentLights = 64;

BenchOptions withView(BenchOptions options, const SglcView& view) {
  options.scene.scene = view.scene;
  if (!view.camera.empty()) options.camera = view.camera;
  if (!view.size.empty()) options.size = view.size;
  return options;
}

double share(double all, double parts) { return parts > 0 ? all / parts : 0; }

}  // namespace

SglcScene::SglcScene(const BenchOptions& options, const SglcSettings& settings,
                     const SglcView& view, Context& context)
    : settings_(settings),
      view_(view),
      context_(context),
      scene_(withView(options, view),
             {.scene = view.scene, .pixels = kPixels, .width = kWidth, .component = "all"},
             context),
      stem_(std::filesystem::path(view.scene).stem().string()) {
  if (!view.camera.empty()) stem_ += "-" + view.camera;
}

void SglcScene::progress(const std::string& what) const {
  const double done = static_cast<double>(outcomes_.size());
  context_.progress(fmt::format("{}{}, {}", kBenchStage, stem_, what), done / (done + 8));
}

std::string SglcScene::description() const {
  return fmt::format("{}: {}x{}, {} pixels compared, {} lights asked for.", stem_,
                     scene_.camera().width, scene_.camera().height, scene_.pixelCount(),
                     view_.lights);
}

BenchScene::Change SglcScene::changeOf(const SglcMethod& method) const {
  return [lights = view_.lights, change = method.change](RenderOptions& options) {
    options.lights = "glossy";
    options.lightCount = lights;
    options.environmentLights = std::max(kLeastEnvironmentLights, lights / kEnvironmentShare);
    options.direct = "lights";
    options.spp = 1;
    change(options);
  };
}

const VirtualLights& SglcScene::lights() {
  if (!lights_) lights_ = scene_.lights(changeOf(defaultMethod()), kSeed);
  return *lights_;
}

std::pair<Receivers, GatherSettings> SglcScene::receivers() {
  return scene_.receivers(changeOf(defaultMethod()), kSeed);
}

SglcOutcome SglcScene::measure(const SglcMethod& method, BenchScene::Extent extent) {
  lights();
  SglcOutcome outcome;
  if (context_.cancelled()) return outcome;
  progress(method.label);
  const Spent spent(context_);
  BenchScene::Gathered gathered = scene_.gathered(&lights_, changeOf(method), kSeed, extent);
  outcome.seconds = spent.total() - spent.seconds("receivers");
  outcome.film = std::move(gathered.film);
  outcome.report = gathered.report;
  outcome.pixels = static_cast<double>(extent == BenchScene::Extent::picture ? scene_.pictureCount()
                                                                             : scene_.pixelCount());
  outcome.trees = spent.seconds("trees");
  outcome.traverse = spent.seconds("traverse");
  outcome.visibility = spent.seconds("visibility");
  outcome.shade = spent.seconds("shade");
  outcome.rays = spent.count("shadow_rays");
  outcome.sharedRays = spent.count("shared_rays");
  outcome.visited = spent.count("node_pairs_visited");
  outcome.shaded = spent.count("node_pairs_shaded");
  outcome.cutNodes = spent.count("cut_lights");
  outcome.lightsPerNode = share(spent.count("clustered_lights"), spent.count("cut_lights"));
  outcome.receiversPerNode =
      share(spent.count("clustered_receivers"), spent.count("receiver_clusters"));
  return outcome;
}

const SglcOutcome& SglcScene::reference() {
  if (!reference_) {
    SglcMethod all = everyLight();
    if (settings_.hasLayers()) {
      all.change = [inner = all.change](RenderOptions& options) {
        inner(options);
        options.aovs = "types";
      };
    }
    reference_ = measure(all, BenchScene::Extent::pixels);
  }
  return *reference_;
}

const SglcOutcome& SglcScene::outcome(const SglcMethod& method) {
  const auto found = outcomes_.find(method.key);
  if (found != outcomes_.end()) return found->second;
  reference();
  SglcOutcome& outcome = outcomes_[method.key];
  if (context_.cancelled()) return outcome;
  outcome = measure(method, BenchScene::Extent::picture);
  if (!context_.cancelled()) outcome.error = compare(outcome.film, reference().film);
  return outcome;
}

double SglcScene::bruteForceSeconds() {
  const SglcOutcome& all = reference();
  return all.seconds * static_cast<double>(scene_.pictureCount()) / all.pixels;
}

ToneCurve SglcScene::toneCurve() { return measureToneCurve(outcome(defaultMethod()).film, {}); }

}  // namespace lobelia::app
