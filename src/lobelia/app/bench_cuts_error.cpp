// Figure 10 of [P004]: frames against the path tracer by the size of the light cut, and with all of
// the light; the same by the bound of the visibility cuts.
#include <fmt/format.h>

#include "lobelia/app/bench_cuts_frames.h"
#include "lobelia/film/metrics.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kReferenceSeed = 42;
constexpr int kReferenceSamples = 1024, kFrameSamples = 16;
constexpr float kSigmas[] = {8, 4, 2, 1};
constexpr size_t kLightCuts[] = {64, 128, 256, 512, 1024, 32768};

class ErrorStudy {
 public:
  ErrorStudy(const std::string& name, const CutsStudy& study)
      : name_(name),
        study_(study),
        options_(optionsOf(name, study)),
        samples_(options_.spp > 0 ? options_.spp : kReferenceSamples),
        scene_(options_, {.scene = name, .component = "all"}, study.context),
        path_(pathReference(scene_, samples_, kReferenceSeed, study.context)),
        objects_(objectsOf(scene_.tracer(), scene_.camera())) {
    settings_.sampleCount = study.sampleCount();
  }

  // Figure 10, and what the cuts themselves cost.
  void run(bool lightCuts, bool sigmas) {
    if (lightCuts && !study_.cancelled()) addLightCuts();
    if (sigmas && !study_.cancelled()) addSigmas();
  }

 private:
  static BenchOptions optionsOf(const std::string& name, const CutsStudy& study) {
    BenchOptions options = study.optionsOf(name);
    if (options.size.empty()) options.size = "320x240";
    return options;
  }

  relight::VisibilityData precomputed() {
    study_.context.seed = options_.seed;
    return relight::precomputeVisibility(scene_.tracer(), settings_, study_.context);
  }
  Film frame(relight::FrameRenderer& renderer, size_t nodes, bool refined) {
    return cutsFrame(renderer, scene_, {nodes, refined, kFrameSamples}, study_.context);
  }
  Comparison errorOf(const Film& film) const {
    return compare(film, path_.first, &path_.second, &objects_);
  }
  std::string note() const {
    return fmt::format(
        "Light from infinity that arrives straight, {}x{}, {} samples of a pixel's filter, pixels "
        "whose neighbours all see a surface. Path tracing: {} samples in two halves.",
        scene_.camera().width, scene_.camera().height, kFrameSamples, samples_);
  }

  void addLightCuts() {
    study_.progress(name_, "precomputation");
    const relight::VisibilityData data = precomputed();
    relight::FrameRenderer renderer(scene_.tracer(), scene_.emitters(), data);
    BenchTable& table = study_.report.table(
        {"figure10",
         "Figure 10: error by the size of the light cut",
         {{"scene", "scene"},
          {"nodes", "light cut", "{:.0f}"},
          {"lobes", "narrow lobes"},
          {"l2", "l2", "{:.4f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"}},
         {},
         {note() + " Narrow lobes: with finer light where they look (refined), or by the light cut "
                   "alone (plain, the paper's)."}});
    const ToneCurve curve = measureToneCurve(path_.first, {});
    std::vector<FigurePicture> line{
        {"path tracer",
         study_.report.picture(fmt::format("figure10-{}-path", name_), path_.first, curve)}};
    for (const size_t nodes : kLightCuts)
      for (const bool refined : {true, false}) {
        if (study_.cancelled() || nodes > data.samples.count()) continue;
        study_.progress(name_, fmt::format("light cut of {}", nodes));
        const Film film = frame(renderer, nodes, refined);
        const Comparison error = errorOf(film);
        table.rows.push_back({name_, static_cast<double>(nodes),
                              std::string(refined ? "refined" : "plain"), error.l2,
                              error.meanRatio});
        if (refined && (nodes == 64 || nodes == 512))
          line.push_back(
              {fmt::format("{} nodes", nodes),
               study_.report.picture(fmt::format("figure10-{}-{}", name_, nodes), film, curve)});
      }
    study_.report.show("figure10", name_, line);
  }

  void addSigmas() {
    BenchTable& table = study_.report.table({"sigma",
                                             "Error by the cuts' own bound",
                                             {{"scene", "scene"},
                                              {"sigma", "sigma", "{:.1f}"},
                                              {"cut", "cut", "{:.0f}"},
                                              {"rms", "RMS", "{:.3f}"},
                                              {"l2", "l2", "{:.4f}"},
                                              {"mean_ratio", "mean ratio", "{:.4f}"}},
                                             {},
                                             {note() + " Light cuts of 512 nodes."}});
    for (const float sigma : kSigmas) {
      if (study_.cancelled()) return;
      study_.progress(name_, fmt::format("sigma {}", sigma));
      settings_.sigma = sigma;
      const relight::VisibilityData data = precomputed();
      relight::FrameRenderer renderer(scene_.tracer(), scene_.emitters(), data);
      const Comparison error = errorOf(frame(renderer, 512, true));
      const Statistics& s = study_.context.statistics;
      table.rows.push_back({name_, static_cast<double>(sigma), s.value("cut_size"),
                            s.value("cut_rms"), error.l2, error.meanRatio});
    }
  }

  const std::string name_;
  const CutsStudy& study_;
  const BenchOptions options_;
  const int samples_;
  BenchScene scene_;
  const Reference path_;
  const Film objects_;
  relight::PrecomputeSettings settings_;
};

}  // namespace

void cutsError(const std::string& name, bool lightCuts, bool sigmas, const CutsStudy& study) {
  ErrorStudy(name, study).run(lightCuts, sigmas);
}

}  // namespace lobelia::app
