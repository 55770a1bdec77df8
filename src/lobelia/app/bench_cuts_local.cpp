// Figure 9 of [P004], scenes under local lights: precomputation for one bounce of indirect light,
// and frames per second while view, lights and materials change with every frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "lobelia/app/bench_cuts.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/temporary_file.h"
#include "lobelia/relight/local_frame.h"
#include "lobelia/relight/local_sources.h"

namespace lobelia::app {
namespace {

constexpr int kFrames = 6;
constexpr float kMoved = 0.02f;  // lights, of the scene's diagonal

double processorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double savedBytes(const relight::VisibilityData& data, const Scene& scene) {
  const TemporaryFile file;
  relight::save(data, scene, file.path());
  return static_cast<double>(std::filesystem::file_size(file.path()));
}

class LocalStudy {
 public:
  LocalStudy(const std::string& name, const CutsStudy& study)
      : name_(name),
        study_(study),
        options_(study.optionsOf(name)),
        scene_(loadScene(options_.scene, study.context)),
        emitters_(scene_.emitters),
        materials_(scene_.materials),
        camera_(timedCamera(scene_, options_)),
        tracer_(scene_, study.context) {}

  void run() {
    const Statistics& s = study_.context.statistics;
    const uint64_t rays = s.count("shadow_rays");
    const int64_t start = nanosecondsNow();
    const double busy = processorSeconds();
    const std::optional<relight::VisibilityData> made =
        surfaceData(name_, tracer_, "9-local", study_);
    if (!made) return;
    const relight::VisibilityData& data = *made;
    const double seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
    const double worked = processorSeconds() - busy;
    const double megabytes = 1e-6 * savedBytes(data, scene_);
    std::vector<BenchCell> row = {name_,
                                  static_cast<double>(data.cuts.count()),
                                  seconds,
                                  worked,
                                  1e-6 * static_cast<double>(s.count("shadow_rays") - rays),
                                  megabytes,
                                  s.value("cut_size"),
                                  s.value("cut_rms")};
    const EmitterSampler sampler(scene_, tracer_.bounds());
    relight::LocalRenderer renderer(tracer_, sampler, data);
    for (const size_t lightCut : kPaperLightCuts) addFrames(renderer, lightCut, &row);
    table().rows.push_back(std::move(row));
  }

 private:
  // What a person may change at once: the view, where lights are, how rough things are.
  void frame(relight::LocalRenderer& renderer, size_t nodes, int i) {
    Camera camera = camera_;
    camera.toWorld = Transform(camera_.toWorld.to * rotation({0, 1, 0}, 0.5 * i));
    scene_.materials = materials_;
    changeRoughness(scene_.materials, i);
    scene_.emitters = emitters_;
    const double away =
        static_cast<double>(kMoved * length(tracer_.bounds().extent())) * std::sin(2.0 * i);
    for (Emitter& e : scene_.emitters)
      if (e.type != EmitterType::area)
        e.toWorld = Transform(translation({away, 0, 0}) * e.toWorld.to);
    const EmitterSampler sampler(scene_, tracer_.bounds());
    renderer.relight(sampler);
    const relight::LocalSettings settings{.nodeCount = nodes, .hideEmitters = scene_.hideEmitters};
    Film film = emptyFrame(camera);
    renderer.render(renderer.light(settings, study_.context), camera, settings, film,
                    study_.context);
  }

  // Frames per second, and seconds of processors for each.
  void addFrames(relight::LocalRenderer& renderer, size_t nodes, std::vector<BenchCell>* row) {
    frame(renderer, nodes, 0);
    const int64_t start = nanosecondsNow();
    const double busy = processorSeconds();
    for (int i = 1; i <= kFrames; ++i) frame(renderer, nodes, i);  // throws when cancelled
    row->emplace_back(1e9 * kFrames / static_cast<double>(nanosecondsNow() - start));
    row->emplace_back((processorSeconds() - busy) / kFrames);
    scene_.materials = materials_;
    scene_.emitters = emitters_;
  }

  BenchTable& table() {
    return study_.report.table(
        {"figure9_local",
         "Figure 9, local lights: one bounce from surfaces",
         {{"scene", "scene"},
          {"vertices", "vertices", "{:.0f}"},
          {"seconds", "made in s", "{:.1f}"},
          {"cpu", "CPU s", "{:.1f}"},
          {"mrays", "million rays", "{:.0f}"},
          {"mb", "MB", "{:.1f}"},
          {"cut", "cut", "{:.0f}"},
          {"rms", "RMS", "{:.3f}"},
          {"fps128", "frames/s, 128", "{:.1f}"},
          {"cpu128", "CPU s", "{:.2f}"},
          {"fps256", "256", "{:.1f}"},
          {"cpu256", "CPU s", "{:.2f}"},
          {"fps512", "512", "{:.1f}"},
          {"cpu512", "CPU s", "{:.2f}"}},
         {},
         {fmt::format("{} samples on surfaces, sigma {}. Frames: {}x{}, the mean of {}, of which "
                      "each has another view, other places of lights and other roughnesses.",
                      study_.sampleCount(), kLocalSigma, camera_.width, camera_.height, kFrames)}});
  }

  const std::string name_;
  const CutsStudy& study_;
  const BenchOptions options_;
  Scene scene_;
  const std::vector<Emitter> emitters_;
  const std::vector<Material> materials_;
  const Camera camera_;
  const Tracer tracer_;
};

}  // namespace

std::optional<relight::VisibilityData> surfaceData(const std::string& name, const Tracer& tracer,
                                                   const char* figure, const CutsStudy& study) {
  const std::vector<Emitter>& emitters = tracer.scene().emitters;
  if (std::none_of(emitters.begin(), emitters.end(),
                   [](const Emitter& e) { return relight::isLocal(e.type); })) {
    study.context.info(
        fmt::format("{} has no local lights: it is left out of figure {}", name, figure));
    return {};
  }
  study.progress(name, "data of surfaces");
  relight::PrecomputeSettings settings;
  settings.light = relight::LightSamples::Kind::surfaces;
  settings.sigma = kLocalSigma;
  settings.sampleCount = study.sampleCount();
  study.context.seed = study.options.seed;
  return relight::precomputeVisibility(tracer, settings, study.context);
}

void cutsLocalData(const std::string& name, const CutsStudy& study) {
  LocalStudy(name, study).run();
}

}  // namespace lobelia::app
