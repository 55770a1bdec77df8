// Figure 9 of [P004]: precomputation by the geometric and by the data-driven metric, and frames per
// second while view, light and materials change with every frame.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "lobelia/app/bench_cuts.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/app/temporary_file.h"

namespace lobelia::app {
namespace {

constexpr float kSigma = 1.2f;  // of a node: the RMS errors are about the paper's
constexpr int kFrames = 12;
constexpr float kMetrics[] = {1, 0.45f};  // beta

double secondsSince(int64_t start) { return 1e-9 * static_cast<double>(nanosecondsNow() - start); }

class DataStudy {
 public:
  DataStudy(const std::string& name, const CutsStudy& study)
      : name_(name),
        study_(study),
        options_(study.optionsOf(name)),
        scene_(loadScene(options_.scene, study.context)),
        materials_(scene_.materials),
        camera_(timedCamera(scene_, options_)),
        tracer_(scene_, study.context),
        emitters_(scene_, tracer_.bounds()) {}

  void run() {
    double geometric = 0;  // size of the cuts
    for (const float beta : kMetrics) {
      if (study_.cancelled()) return;
      study_.progress(name_, beta < 1 ? "data-driven" : "geometric");
      add(beta, &geometric);
    }
  }

 private:
  void add(float beta, double* geometric) {
    relight::PrecomputeSettings settings;
    settings.beta = beta, settings.sigma = kSigma;
    settings.sampleCount = study_.sampleCount();
    const Statistics& s = study_.context.statistics;
    const auto counted = [&](const char* name) { return static_cast<double>(s.count(name)); };
    const double rays = counted("shadow_rays"), nodes = counted("cut_nodes");
    const double vertices = counted("vertices");
    study_.context.seed = options_.seed;
    const int64_t start = nanosecondsNow();
    const relight::VisibilityData data =
        relight::precomputeVisibility(tracer_, settings, study_.context);
    const double made = secondsSince(start);
    const TemporaryFile file;
    relight::save(data, scene_, file.path());
    const int64_t saved = nanosecondsNow();
    relight::load(file.path(), scene_);
    const double loaded = secondsSince(saved);
    const double bytes = static_cast<double>(std::filesystem::file_size(file.path()));
    const double size = s.value("cut_size");
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::vector<BenchCell> row = {name_,
                                  counted("vertices") - vertices,
                                  std::string(beta < 1 ? "data-driven" : "geometric"),
                                  made,
                                  1e-6 * (counted("shadow_rays") - rays),
                                  1e-6 * bytes,
                                  loaded,
                                  size,
                                  s.value("cut_rms"),
                                  s.value("cut_rms_all"),
                                  bytes / (counted("cut_nodes") - nodes),
                                  beta < 1 ? 1 - size / *geometric : kNone};
    if (!(beta < 1)) *geometric = size;
    for (const size_t lightCut : kPaperLightCuts)
      row.emplace_back(beta < 1 ? framesPerSecond(data, lightCut) : kNone);
    table().rows.push_back(std::move(row));
  }

  // What a person may change at once: the view, where the light comes from, how rough things are.
  double framesPerSecond(const relight::VisibilityData& data, size_t nodes) {
    relight::FrameRenderer renderer(tracer_, emitters_, data);
    const auto frame = [&](int i) {
      Camera camera = camera_;
      const Vec3f middle = tracer_.bounds().centre();
      const Vec3d centre{double{middle.x}, double{middle.y}, double{middle.z}};
      camera.toWorld = Transform(translation(centre) * rotation({0, 1, 0}, 2.0 * i) *
                                 translation(-centre) * camera_.toWorld.to);
      scene_.materials = materials_;
      changeRoughness(scene_.materials, i);
      Film film = emptyFrame(camera);
      const relight::FrameLight light =
          renderer.light(5.0 * i, {.nodeCount = nodes}, study_.context);
      renderer.render(light, camera, {.hideEmitters = scene_.hideEmitters}, film, study_.context);
    };
    frame(0);
    const int64_t start = nanosecondsNow();
    for (int i = 1; i <= kFrames; ++i) frame(i);  // throws when cancelled
    const double seconds = secondsSince(start);
    scene_.materials = materials_;
    return kFrames / seconds;
  }

  BenchTable& table() {
    return study_.report.table(
        {"figure9",
         "Figure 9: visibility cuts, their size and time, and frames per second",
         {{"scene", "scene"},
          {"vertices", "vertices", "{:.0f}"},
          {"metric", "light tree"},
          {"seconds", "made in s", "{:.1f}"},
          {"mrays", "million rays", "{:.0f}"},
          {"mb", "MB", "{:.1f}"},
          {"load", "loaded in s", "{:.2f}"},
          {"cut", "cut", "{:.0f}"},
          {"rms", "RMS", "{:.3f}"},
          {"rms_all", "RMS, all samples", "{:.3f}"},
          {"bytes", "bytes per node", "{:.2f}"},
          {"gain", "gain", "{:.2f}"},
          {"fps128", "frames/s, 128", "{:.1f}"},
          {"fps256", "256", "{:.1f}"},
          {"fps512", "512", "{:.1f}"}},
         {},
         {fmt::format("{} directions, sigma {}, cuts of at most 1,000 nodes. RMS: over samples "
                      "in front of a vertex' faces, where light can matter; and over all. Frames: "
                      "{}x{}, the mean of {}, of which each has another view, light from elsewhere "
                      "and other roughnesses.",
                      study_.sampleCount(), kSigma, camera_.width, camera_.height, kFrames)}});
  }

  const std::string name_;
  const CutsStudy& study_;
  const BenchOptions options_;
  Scene scene_;
  const std::vector<Material> materials_;
  const Camera camera_;
  const Tracer tracer_;
  const EmitterSampler emitters_;
};

}  // namespace

void cutsData(const std::string& name, const CutsStudy& study) { DataStudy(name, study).run(); }

}  // namespace lobelia::app
