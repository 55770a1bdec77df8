// Frames of a camera that turns slowly about the scene, in one set of lights: how much each pixel
// changes from frame to frame, by the default and by brute force, and how much of it is error that
// changes, which is seen as flicker.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "lobelia/app/bench_plot.h"
#include "lobelia/app/bench_sglc.h"
#include "lobelia/film/color_map.h"
#include "lobelia/scene/camera_path.h"

namespace lobelia::app {
namespace {

constexpr int kFrames = 24;
constexpr double kTurn = 1. / 1440;  // a frame's part of a turn
constexpr float kDifferenceScale = 4;

struct Frame {
  Film film, reference;
};

// Root of the sum of squares of f(pixel) over the reference's pixels and channels. Values that are
// not finite are left out: compare() counts them.
template <class F>
double norm(const Film& reference, const F& f) {
  double sum = 0;
  for (size_t i = 0; i < reference.pixelCount(); ++i) {
    if (!reference.alpha.empty() && reference.alpha[i] == 0) continue;
    const Rgb v = f(i);
    const double square = static_cast<double>(v.x * v.x + v.y * v.y + v.z * v.z);
    if (std::isfinite(square)) sum += square;
  }
  return std::sqrt(sum);
}

class Frames {
 public:
  Frames(SglcScene& scene, FigureReport& report) : scene_(scene), report_(report) {}

  void run(Context& context) {
    BenchScene& view = scene_.scene();
    const Camera begin = view.camera();
    const Bounds3f& bounds = view.tracer().bounds();
    const Vec3d pivot = turntablePivot(begin, bounds), axis = verticalAxis(begin);
    std::optional<VirtualLights> lights = scene_.lights();
    const auto gathered = [&](const SglcMethod& method, BenchScene::Extent extent) {
      return view.gathered(&lights, scene_.changeOf(method), kSeed, extent).film;
    };
    Frame before;
    for (int number = 0; number < kFrames && !context.cancelled(); ++number) {
      scene_.progress(fmt::format("frame {} of {}", number + 1, kFrames));
      view.setCamera(turned(begin, pivot, axis, number * kTurn));
      Frame now{gathered(defaultMethod(), BenchScene::Extent::picture),
                gathered(everyLight(), BenchScene::Extent::pixels)};
      if (!context.cancelled()) add(number, number > 0 ? &before : nullptr, now);
      before = std::move(now);
    }
    view.setCamera(begin);
    if (!context.cancelled()) finish();
  }

 private:
  static constexpr uint64_t kSeed = 43;

  BenchTable& table() {
    return report_.table(
        {"frames",
         "Frames of a camera that moves: the default and every light",
         {{"scene", "scene"},
          {"frame", "frame", "{:.0f}"},
          {"l2", "l2", "{:.4f}"},
          {"change", "change of a pixel", "{:.4f}"},
          {"change_every_light", "by every light", "{:.4f}"},
          {"change_of_error", "of the error", "{:.4f}"}},
         {},
         {fmt::format(
             "The camera turns about what it looks at by {:g} degrees a frame. l2 of a "
             "frame against every light at the pixels compared; root mean squares of "
             "differences to the frame before, over the root mean square of every light. "
             "Row \"mean\": of a scene's frames. Errors of neighbouring frames that have nothing "
             "in common change by l2 times the root of two.",
             360 * kTurn)}});
  }

  void add(int number, const Frame* before, const Frame& now) {
    const Film& reference = now.reference;
    const double whole = norm(reference, [&](size_t i) { return reference.rgb(i); });
    const double l2 = compare(now.film, reference).l2;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double change[3] = {kNone, kNone, kNone};
    if (before != nullptr) {
      const auto ours = [&](size_t i) { return now.film.rgb(i) - before->film.rgb(i); };
      const auto all = [&](size_t i) { return reference.rgb(i) - before->reference.rgb(i); };
      change[0] = norm(reference, ours) / whole;
      change[1] = norm(reference, all) / whole;
      change[2] = norm(reference, [&](size_t i) { return ours(i) - all(i); }) / whole;
      for (int k = 0; k < 3; ++k) curves_[k].points.emplace_back(number, change[k]);
      for (int k = 0; k < 3; ++k) means_[k + 1] += change[k] / (kFrames - 1);
    }
    means_[0] += l2 / kFrames;
    table().rows.push_back(
        {scene_.stem(), static_cast<double>(number), l2, change[0], change[1], change[2]});
    if (before != nullptr && number == kFrames / 2) show(*before, now);
  }

  // One frame and what changed before it.
  void show(const Frame& before, const Frame& now) {
    if (!report_.hasPictures()) return;
    const std::string name = "frames-" + scene_.stem();
    const float scale = static_cast<float>(meanLuminance(now.film)) / kDifferenceScale;
    const auto pictures = [&](const std::string& key, const std::string& label, const Film& a,
                              const Film& b) {
      line_.push_back(
          {label, report_.picture(name + "-" + key, b, measureToneCurve(now.film, {}))});
      line_.push_back(
          {fmt::format("{}: change x{:g}", label, kDifferenceScale),
           report_.picture(name + "-" + key + "-change", absoluteDifference(b, a, scale), b)});
    };
    pictures("default", defaultMethod().label, before.film, now.film);
    if (scene_.referenceIsWhole()) pictures("all", "every light", before.reference, now.reference);
  }

  void finish() {
    table().rows.push_back({scene_.stem(), "mean", means_[0], means_[1], means_[2], means_[3]});
    table().notes.push_back(scene_.description());
    if (!report_.hasPictures()) return;
    line_.push_back({"change of pixels over frames",
                     report_.drawing("frames-" + scene_.stem(),
                                     logLogPlot("frame", "change", {curves_, curves_ + 3}))});
    report_.show("frames", scene_.stem(), std::move(line_));
  }

  SglcScene& scene_;
  FigureReport& report_;
  PlotCurve curves_[3] = {{defaultMethod().label, {}}, {"every light", {}}, {"error", {}}};
  double means_[4] = {};
  std::vector<FigurePicture> line_;
};

}  // namespace

void sglcFrames(SglcScene& scene, FigureReport& report, Context& context) {
  scene.lights();
  if (context.cancelled() || scene.lights().size() == 0) return;
  Frames(scene, report).run(context);
}

}  // namespace lobelia::app
