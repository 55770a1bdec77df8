// Figure 7 of [P004]: direct light of lamps beside direct light and one bounce, each against the
// path tracer. The paper shows pictures without a reference.
#include <fmt/format.h>

#include "lobelia/app/bench_cuts.h"
#include "lobelia/app/bench_cuts_frames.h"
#include "lobelia/film/metrics.h"
#include "lobelia/relight/local_frame.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kReferenceSeed = 43;
constexpr int kReferenceSamples = 256, kFrameSamples = 16;

class BounceStudy {
 public:
  BounceStudy(const std::string& name, const CutsStudy& study)
      : name_(name),
        study_(study),
        samples_(study.options.spp > 0 ? study.options.spp : kReferenceSamples) {}

  void run() {
    BenchScene scene = sceneOf(2);
    const std::optional<relight::VisibilityData> data =
        surfaceData(name_, scene.tracer(), "7", study_);
    if (!data) return;
    relight::LocalRenderer renderer(scene.tracer(), scene.emitters(), *data);
    BenchScene bounced = sceneOf(3);
    add("direct", false, scene, renderer);
    add("direct and one bounce", true, bounced, renderer);
    study_.report.show("figure7", name_, pictures_);
  }

 private:
  BenchScene sceneOf(int depth) const {
    BenchOptions options = study_.optionsOf(name_);
    if (options.size.empty()) options.size = "320x240";
    options.maxDepth = depth;
    return BenchScene(options, {.scene = name_, .component = "all"}, study_.context);
  }

  // reference: the same scene for the path tracer, to the depth of this light.
  void add(const std::string& light, bool bounce, BenchScene& reference,
           relight::LocalRenderer& renderer) {
    if (study_.cancelled()) return;
    study_.progress(name_, light);
    const relight::LocalSettings settings{.spp = kFrameSamples,
                                          .bounced = bounce,
                                          .hideEmitters = reference.tracer().scene().hideEmitters};
    Film film = emptyFrame(reference.camera());
    const int64_t start = nanosecondsNow();
    renderer.render(renderer.light(settings, study_.context), reference.camera(), settings, film,
                    study_.context);
    const double seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
    const Reference path = pathReference(reference, samples_, kReferenceSeed, study_.context);
    if (study_.cancelled()) return;
    const Film objects = objectsOf(reference.tracer(), reference.camera());
    const Comparison error = compare(film, path.first, &path.second, &objects);
    table(reference.camera()).rows.push_back({name_, light, error.l2, error.meanRatio, seconds});
    if (!curve_) curve_ = measureToneCurve(path.first, {});
    const auto picture = [&](const char* method, const Film& shown) {
      const std::string file =
          fmt::format("figure7-{}-{}-{}", name_, bounce ? "bounce" : "direct", method);
      pictures_.push_back({light + ", " + method, study_.report.picture(file, shown, *curve_)});
    };
    picture("cuts", film);
    picture("path", path.first);
  }

  BenchTable& table(const Camera& camera) {
    return study_.report.table(
        {"figure7",
         "Figure 7: direct light, and one bounce of it",
         {{"scene", "scene"},
          {"light", "light"},
          {"l2", "l2", "{:.4f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"},
          {"seconds", "seconds", "{:.1f}"}},
         {},
         {fmt::format("Light of lamps. {}x{}, light cuts of 512 nodes, {} samples of a pixel's "
                      "filter, pixels whose neighbours all see a surface; path tracing: {} samples "
                      "in two halves, depth 2 and 3.",
                      camera.width, camera.height, kFrameSamples, samples_)}});
  }

  const std::string name_;
  const CutsStudy& study_;
  const int samples_;
  std::optional<ToneCurve> curve_;  // of all pictures
  std::vector<FigurePicture> pictures_;
};

}  // namespace

void cutsBounce(const std::string& name, const CutsStudy& study) { BounceStudy(name, study).run(); }

}  // namespace lobelia::app
