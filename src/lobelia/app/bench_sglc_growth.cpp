// Figure 9 [P000]: how time and rays of gathering grow with lights and with pixels, at every
// strategy's defaults, with the error beside; of the default also at one error; and brute force,
// extrapolated from the pixels compared.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobelia/app/bench_plot.h"
#include "lobelia/app/bench_sglc.h"

namespace lobelia::app {
namespace {

constexpr double kFirstLights = 10'000, kLightFactor = 3.16227766;
constexpr int kCoarsest = 8;    // pictures begin at this part of the side asked for
constexpr int kSideFactor = 2;  // between them
constexpr const char* kNaive = "every light";
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostSteps = 3;      // of quality, to reach an error
constexpr double kStepFactor = 2;  // of a step

struct Grown {  // a method's points
  std::string label;
  std::vector<std::pair<double, double>> seconds, rays;
};

class Growth {
 public:
  // asked: what grows as far as asked for; its error is that of the default at equal error.
  Growth(std::string key, std::string title, std::string label, SglcScene& asked,
         FigureReport& report)
      : key_(std::move(key)),
        label_(std::move(label)),
        report_(report),
        error_(asked.outcome(defaultMethod()).error.l2) {
    table().title = std::move(title);
  }

  void add(SglcScene& scene, double x, Context& context) {
    for (const SglcMethod& method : sglcMethods(scene.settings())) {
      const SglcOutcome& o = scene.outcome(method);
      if (context.cancelled()) return;
      table().rows.push_back({scene.stem(), method.label, x, o.seconds, o.per(o.rays),
                              o.visitedOrNone(), o.error.l2, o.error.meanRatio});
      addPoint(method.label, x, o.seconds, o.rays);
    }
    addEqual(scene, x, context);
    const SglcOutcome& all = scene.reference();
    if (context.cancelled()) return;
    table().rows.push_back({scene.stem(), kNaive, x, scene.bruteForceSeconds(), all.per(all.rays),
                            kNone, kNone, kNone});
    addPoint(kNaive, x, scene.bruteForceSeconds(),
             all.per(all.rays) * static_cast<double>(scene.scene().pictureCount()));
  }

  void finish(const std::string& stem) {
    BenchTable& exponents = report_.table({"figure9",
                                           "Figure 9: exponents of growth",
                                           {{"scene", "scene"},
                                            {"method", "method"},
                                            {"over", "over"},
                                            {"from", "from", "{:.0f}"},
                                            {"to", "to", "{:.0f}"},
                                            {"seconds", "of seconds", "{:.2f}"},
                                            {"rays", "of rays", "{:.2f}"}},
                                           {},
                                           {"Least squares in logarithms."}});
    std::vector<PlotCurve> curves;
    for (const Grown& grown : grown_) {
      exponents.rows.push_back({stem, grown.label, label_, grown.seconds.front().first,
                                grown.seconds.back().first, growthExponent(grown.seconds),
                                growthExponent(grown.rays)});
      curves.push_back({grown.label, grown.seconds});
    }
    if (!report_.hasPictures()) return;
    report_.show(key_, stem,
                 {{"seconds over " + label_,
                   report_.drawing(key_ + "-" + stem, logLogPlot(label_, "seconds", curves))}});
  }

 private:
  // The default at the error of what is asked for: between the qualities on both sides of it.
  void addEqual(SglcScene& scene, double x, Context& context) {
    const SglcMethod method = defaultMethod();
    const SglcQuality& quality = *qualityOf(method);
    std::vector<std::pair<double, double>> seconds, rays, visited;  // by error
    double value = quality.normal;
    bool above = false, below = false;
    for (int step = 0; step <= kMostSteps && !(above && below); ++step) {
      const SglcOutcome& o = scene.outcome(withQuality(method, quality, value));
      if (context.cancelled()) return;
      for (const auto& [curve, y] : {std::pair{&seconds, o.seconds}, std::pair{&rays, o.rays},
                                     std::pair{&visited, o.visited}})
        curve->emplace_back(o.error.l2, y);
      above = above || o.error.l2 >= error_, below = below || o.error.l2 <= error_;
      value *= o.error.l2 > error_ ? kStepFactor : 1 / kStepFactor;
    }
    const auto at = [&](const auto& curve) { return interpolated(curve, error_); };
    const std::string label = method.label + ", equal l2";
    const double time = at(seconds), allRays = at(rays), all = at(visited);
    const double count = static_cast<double>(scene.scene().pictureCount());
    table().rows.push_back({scene.stem(), label, x, time, allRays / count, all / count,
                            std::isfinite(time) ? error_ : kNone, kNone});
    if (std::isfinite(time)) addPoint(label, x, time, allRays);
  }

  BenchTable& table() {
    return report_.table(
        {key_,
         "",
         {{"scene", "scene"},
          {"method", "method"},
          {label_, label_, "{:.0f}"},
          {"seconds", "seconds", "{:.2f}"},
          {"rays_per_pixel", "rays per pixel", "{:.1f}"},
          {"visited_per_pixel", "nodes visited per pixel", "{:.1f}"},
          {"l2", "l2", "{:.4f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"}},
         {},
         {"Seconds of whole pictures; of every light extrapolated from the pixels "
          "compared. Equal l2: that of the default for all that is asked for, "
          "between two cut sizes interpolated in logarithms; \"-\", and not in the "
          "exponents, where an eighth of the nodes to eight times as many do not "
          "reach it."}});
  }
  void addPoint(const std::string& label, double x, double seconds, double rays) {
    auto found = std::find_if(grown_.begin(), grown_.end(),
                              [&](const Grown& grown) { return grown.label == label; });
    if (found == grown_.end()) found = grown_.insert(grown_.end(), {label, {}, {}});
    found->seconds.emplace_back(x, seconds);
    found->rays.emplace_back(x, rays);
  }

  std::string key_, label_;
  FigureReport& report_;
  double error_;
  std::vector<Grown> grown_;
};

// From 10^4 (or a tenth of what is asked for) up, by the square root of ten.
std::vector<uint64_t> lightCounts(uint64_t most) {
  std::vector<uint64_t> counts;
  const double last = static_cast<double>(most);
  for (double n = std::max(1.0, std::min(kFirstLights, last / 10)); n < 0.8 * last;
       n *= kLightFactor)
    counts.push_back(static_cast<uint64_t>(std::llround(n)));
  counts.push_back(most);
  return counts;
}

}  // namespace

void sglcLightGrowth(const BenchOptions& options, SglcScene& scene, FigureReport& report,
                     Context& context) {
  Growth lights("figure9_lights", "Figure 9a: growth with lights", "lights", scene, report);
  if (context.cancelled()) return;
  for (const uint64_t count : lightCounts(scene.view().lights)) {
    if (count == scene.view().lights) {
      lights.add(scene, static_cast<double>(scene.lights().size()), context);
    } else {
      SglcView fewer = scene.view();
      fewer.lights = count;
      SglcScene smaller(options, scene.settings(), fewer, context);
      const double made = static_cast<double>(smaller.lights().size());
      lights.add(smaller, made, context);
    }
    if (context.cancelled()) return;
  }
  lights.finish(scene.stem());
}

void sglcPixelGrowth(const BenchOptions& options, SglcScene& scene, FigureReport& report,
                     Context& context) {
  Growth pixels("figure9_pixels", "Figure 9b: growth with pixels", "pixels", scene, report);
  if (context.cancelled()) return;
  const Camera& camera = scene.scene().camera();
  for (int divisor = kCoarsest; divisor >= 1; divisor /= kSideFactor) {
    if (divisor == 1) {
      pixels.add(scene, static_cast<double>(scene.scene().pictureCount()), context);
    } else {
      SglcView coarse = scene.view();
      coarse.size = fmt::format("{}x{}", std::max(1, camera.width / divisor),
                                std::max(1, camera.height / divisor));
      SglcScene smaller(options, scene.settings(), coarse, context);
      pixels.add(smaller, static_cast<double>(smaller.scene().pictureCount()), context);
    }
    if (context.cancelled()) return;
  }
  pixels.finish(scene.stem());
}

}  // namespace lobelia::app
