// Figure 6 of [P004]: one object in many materials, drawn from the same visibility, beside the path
// tracer. The paper changes the light from picture to picture, too; here it is the scene's own in
// all of them, so that one light cut serves and the pictures differ by their material alone.
#include <fmt/format.h>

#include "lobelia/app/bench_cuts_designs.h"
#include "lobelia/app/bench_cuts_frames.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kReferenceSeed = 43;
constexpr int kReferenceSamples = 256, kFrameSamples = 16, kTimedFrames = 5;

class MaterialStudy {
 public:
  MaterialStudy(const std::string& name, const CutsStudy& study)
      : name_(name),
        study_(study),
        options_(optionsOf(name, study)),
        samples_(options_.spp > 0 ? options_.spp : kReferenceSamples),
        scene_(options_,
               {.scene = name,
                .component = "all",
                .prepare = [&](Scene& scene) { addDesignsTo(scene); }},
               study.context),
        objects_(objectsOf(scene_.tracer(), scene_.camera())) {}

  void run() {
    if (!object_.valid()) return;
    study_.progress(name_, "precomputation");
    relight::PrecomputeSettings settings;
    settings.sampleCount = study_.sampleCount();
    study_.context.seed = options_.seed;
    const relight::VisibilityData data =
        relight::precomputeVisibility(scene_.tracer(), settings, study_.context);
    relight::FrameRenderer renderer(scene_.tracer(), scene_.emitters(), data);
    std::vector<FigurePicture> frames, references;
    for (const MaterialDesign& design : designs_) {
      if (study_.cancelled()) break;
      study_.progress(name_, design.name);
      scene_.setMaterial(object_, design.material);
      add(design.name, renderer, &frames, &references);
    }
    study_.report.show("figure6", name_ + ", visibility cuts", frames);
    study_.report.show("figure6", name_ + ", path tracing", references);
  }

 private:
  static BenchOptions optionsOf(const std::string& name, const CutsStudy& study) {
    BenchOptions options = study.optionsOf(name);
    if (options.size.empty()) options.size = "320x240";
    return options;
  }

  void addDesignsTo(Scene& scene) {
    object_ = largestMaterial(scene);
    if (object_.valid()) designs_ = addDesigns(scene, object_);
  }

  double framesPerSecond(relight::FrameRenderer& renderer) {
    cutsFrame(renderer, scene_, {.spp = 1}, study_.context);
    const int64_t start = nanosecondsNow();
    for (int i = 0; i < kTimedFrames; ++i) cutsFrame(renderer, scene_, {.spp = 1}, study_.context);
    return kTimedFrames / (1e-9 * static_cast<double>(nanosecondsNow() - start));
  }

  void add(const std::string& design, relight::FrameRenderer& renderer,
           std::vector<FigurePicture>* frames, std::vector<FigurePicture>* references) {
    const double rate = framesPerSecond(renderer);
    const Film film = cutsFrame(renderer, scene_, {.spp = kFrameSamples}, study_.context);
    const Reference path = pathReference(scene_, samples_, kReferenceSeed, study_.context);
    if (study_.cancelled()) return;
    const Comparison error = compare(film, path.first, &path.second, &objects_);
    table().rows.push_back({name_, design, error.l2, error.meanRatio, rate});
    const ToneCurve curve = measureToneCurve(path.first, {});
    const auto picture = [&](const char* method, const Film& shown) -> FigurePicture {
      return {design, study_.report.picture(fmt::format("figure6-{}-{}-{}", name_, design, method),
                                            shown, curve)};
    };
    frames->push_back(picture("cuts", film));
    references->push_back(picture("path", path.first));
  }

  BenchTable& table() {
    return study_.report.table(
        {"figure6",
         "Figure 6: materials changed without precomputation",
         {{"scene", "scene"},
          {"material", "material"},
          {"l2", "l2", "{:.4f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"},
          {"fps", "frames/s", "{:.1f}"}},
         {},
         {fmt::format("The material of most triangles is changed; the visibility is the same for "
                      "all. {}x{}, light cuts of 512 nodes, {} samples of a pixel's filter, pixels "
                      "whose neighbours all see a surface; path tracing: {} samples in two halves. "
                      "Frames/s: one sample through the pixel's middle.",
                      scene_.camera().width, scene_.camera().height, kFrameSamples, samples_)}});
  }

  const std::string name_;
  const CutsStudy& study_;
  const BenchOptions options_;
  const int samples_;
  MaterialHandle object_;
  std::vector<MaterialDesign> designs_;
  BenchScene scene_;
  const Film objects_;
};

}  // namespace

void cutsMaterials(const std::string& name, const CutsStudy& study) {
  MaterialStudy(name, study).run();
}

}  // namespace lobelia::app
