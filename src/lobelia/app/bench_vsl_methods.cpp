// Methods side by side: figures 1 and 2 (what clamping and diffuse lights lose, and the remedies
// there were), 6 (pictures with direct light) and 7 (their differences from the reference).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/bench_vsl.h"
#include "lobelia/film/color_map.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kDirectSeed = 21;
constexpr int kDirectSamples = 64;

const std::vector<BenchColumn> kColumns = {
    {"scene", "scene"},     {"method", "method"},
    {"clamp", "clamp"},     {"seconds", "seconds", "{:.2f}"},
    {"l2", "l2", "{:.3f}"}, {"mean_ratio", "mean ratio", "{:.4f}"},
    {"picture", "picture"}};

VslMethod unclamped(const std::string& model, const std::string& label) {
  const auto change = [=](RenderOptions& options) {
    options.lights = model;
    options.clamp = "off";
  };
  return {model + "-unclamped", label, change, "off"};
}

// Kollig and Keller's: what the clamp takes is path-traced.
VslMethod compensated() {
  const auto change = [](RenderOptions& options) {
    options.lights = "vpl";
    options.compensate = true;
  };
  return {"vpl-compensated", "VPL, compensated by path tracing", change, ""};
}
VslMethod photons() {
  const auto change = [](RenderOptions& options) {
    options.lights = "photon";
    options.gather = "all";
  };
  return {"photon", "photon map, final gathering", change, ""};
}

std::string countsNote(const VslScene& scene, const BenchScene& bench) {
  const VslSettings& s = scene.settings();
  return fmt::format(
      "{}: indirect light; {} lights, {} columns, {} samples per pixel; {}x{}; l2 and mean ratio "
      "of "
      "{} pixels against two halves of {} path-traced samples each; seconds of {}.",
      scene.name(), s.lights, s.columns, s.eyeSamples, bench.camera().width, bench.camera().height,
      bench.pixelCount(), s.pathSamples / 2,
      s.folder.empty() ? "those pixels" : "the whole picture");
}

// The reference's light that a picture lacks.
Film missing(const Film& film, const Film& reference) {
  Film out = reference;
  std::vector<float>& values = out.layers.at("").values;
  const std::vector<float>& have = film.layers.at("").values;
  for (size_t i = 0; i < values.size(); ++i) values[i] = std::max(0.f, values[i] - have[i]);
  return out;
}

Film sum(const Film& a, const Film& b) {
  Film out = a;
  std::vector<float>& values = out.layers.at("").values;
  const std::vector<float>& more = b.layers.at("").values;
  for (size_t i = 0; i < values.size(); ++i) values[i] += more[i];
  return out;
}

class MethodFigures {
 public:
  MethodFigures(VslScene& scene, FigureReport& report, Context& context)
      : scene_(scene), report_(report), context_(context) {}

  // Figures 1 and 2: numbers and pictures of some methods.
  void sideBySide(int figure, const std::string& title, const std::vector<VslMethod>& methods) {
    const std::string key = fmt::format("figure{}", figure);
    BenchTable& table =
        report_.table({key, fmt::format("Figure {}: {}", figure, title), kColumns, {}, {}});
    std::vector<FigurePicture> line;
    if (report_.hasPictures())
      line.push_back({"reference", save(figure, "reference", scene_.referencePicture())});
    for (const VslMethod& method : methods) {
      const VslOutcome& outcome = scene_.outcome(method);
      if (context_.cancelled()) return;
      const std::string file = save(figure, method.key, outcome.film);
      line.push_back({method.label, file});
      table.rows.push_back({scene_.name(), method.label, method.clamp, outcome.seconds,
                            outcome.error.l2, outcome.error.meanRatio, file});
      if (figure == 1 && method.key == "vpl-clamped" && report_.hasPictures()) {
        line.push_back({"what clamped VPLs miss",
                        save(figure, "missing", missing(outcome.film, scene_.referencePicture()))});
      }
    }
    table.notes.push_back(countsNote(scene_, scene_.scene()));
    report_.show(key, scene_.name(), std::move(line));
  }

  // With direct light, the same for all; errors of the sum.
  void wholePictures(const std::vector<VslMethod>& methods) {
    BenchTable& table = report_.table({"figure6",
                                       "Figure 6: direct and indirect light",
                                       {{"scene", "scene"},
                                        {"method", "method"},
                                        {"l2", "l2", "{:.3f}"},
                                        {"mean_ratio", "mean ratio", "{:.4f}"},
                                        {"picture", "picture"}},
                                       {},
                                       {}});
    scene_.progress("direct light", 0);
    const Film direct = scene_.scene().directLight(
        kDirectSamples, kDirectSeed,
        report_.hasPictures() ? BenchScene::Extent::picture : BenchScene::Extent::pixels);
    const Reference& reference = scene_.reference();
    if (context_.cancelled()) return;
    const Film first = sum(reference.first, direct), second = sum(reference.second, direct);
    std::vector<FigurePicture> line;
    std::optional<ToneCurve> curve;
    const auto add = [&](const std::string& key, const std::string& label, const Film& indirect) {
      const Film film = sum(indirect, direct);
      if (!curve) curve = measureToneCurve(film, {});  // the reference comes first
      line.push_back({label, report_.picture(name(6, key), film, *curve)});
      return film;
    };
    if (report_.hasPictures()) add("reference", "reference", scene_.referencePicture());
    for (const VslMethod& method : methods) {
      const VslOutcome& outcome = scene_.outcome(method);
      if (context_.cancelled()) return;
      const Comparison error = compare(add(method.key, method.label, outcome.film), first, &second);
      table.rows.push_back(
          {scene_.name(), method.label, error.l2, error.meanRatio, line.back().file});
    }
    report_.show("figure6", scene_.name(), std::move(line));
  }

  // In units of the reference's mean: red too bright, blue too dark; and the absolute difference.
  void differences(const std::vector<VslMethod>& methods) {
    BenchTable& table = report_.table({"figure7",
                                       "Figure 7: difference from the reference, indirect light",
                                       {{"scene", "scene"},
                                        {"method", "method"},
                                        {"l2", "l2", "{:.3f}"},
                                        {"mean_ratio", "mean ratio", "{:.4f}"},
                                        {"picture", "picture"},
                                        {"signed", "signed difference"},
                                        {"absolute", "absolute difference"}},
                                       {},
                                       {}});
    std::vector<FigurePicture> line;
    for (const VslMethod& method : methods) {
      const VslOutcome& outcome = scene_.outcome(method);
      if (context_.cancelled()) return;
      const std::string file = save(7, method.key, outcome.film);
      std::string signedFile, absoluteFile;
      if (report_.hasPictures()) {
        const Film& reference = scene_.referencePicture();
        const float scale = kDifferenceScale * static_cast<float>(meanLuminance(reference));
        signedFile = report_.picture(name(7, method.key + "-signed"),
                                     signedDifference(outcome.film, reference, scale), reference);
        absoluteFile =
            report_.picture(name(7, method.key + "-absolute"),
                            absoluteDifference(outcome.film, reference, scale), reference);
      }
      table.rows.push_back({scene_.name(), method.label, outcome.error.l2, outcome.error.meanRatio,
                            file, signedFile, absoluteFile});
      line.insert(line.end(),
                  {{method.label, file}, {"signed", signedFile}, {"absolute", absoluteFile}});
    }
    if (report_.hasPictures())
      line.insert(line.begin(),
                  FigurePicture{"reference", save(7, "reference", scene_.referencePicture())});
    if (table.notes.empty()) {
      table.notes.push_back(fmt::format(
          "Signed differences of luminance: red is too bright, blue too dark, white none; absolute "
          "ones in cubehelix, black is none. Full colour is {} times the reference's mean.",
          kDifferenceScale));
    }
    report_.show("figure7", scene_.name(), std::move(line));
  }

 private:
  static constexpr float kDifferenceScale = 2;

  std::string name(int figure, const std::string& key) const {
    return fmt::format("figure{}-{}-{}", figure, scene_.stem(), key);
  }
  std::string save(int figure, const std::string& key, const Film& film) {
    return report_.hasPictures() ? report_.picture(name(figure, key), film, scene_.toneCurve())
                                 : "";
  }

  VslScene& scene_;
  FigureReport& report_;
  Context& context_;
};

}  // namespace

void vslMethodFigures(VslScene& scene, FigureReport& report, Context& context) {
  MethodFigures figures(scene, report, context);
  const VslSettings& settings = scene.settings();
  const auto three = [&] {
    return std::vector{scene.clamped("vpl", "VPL, best clamp"), scene.asInThePaper(), scene.ours()};
  };
  if (settings.has(1) && !context.cancelled())
    figures.sideBySide(1, "what clamping and diffuse lights lose", three());
  if (settings.has(2) && !context.cancelled()) {
    figures.sideBySide(
        2, "other remedies",
        {unclamped("vpl", "VPL, no clamp"), unclamped("glossy", "glossy VPL, no clamp"),
         scene.clamped("glossy", "glossy VPL, best clamp"), compensated(), photons()});
  }
  if (settings.has(6) && !context.cancelled()) figures.wholePictures(three());
  if (settings.has(7) && !context.cancelled()) figures.differences(three());
}

}  // namespace lobelia::app
