// Figures 4 and 5 [Hasan09], in boxes made for them: what is left of corner darkening in a diffuse
// scene, and how noisy the integral over one large spherical light is by each way of sampling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/app/bench_studies.h"
#include "lobelia/app/bench_vsl.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kCornerLights = 4096;  // few, as corners need them

// Figure 5: "a single VSL with relatively large radius is located on the left wall of the box. All
// surfaces have a glossy Ward BRDF component with alpha = 0.03."
constexpr float kLargeRadius = 0.5f, kSpecularLimit = 0.02f;
constexpr uint64_t kCandidates = 2000, kLightSeed = 31, kEyeSeed = 32;
constexpr int kExactSamples = 4096;

// The one nearest to the middle of the left wall of the light that has been scattered once.
VirtualLights oneLight(BenchScene& scene, const BenchScene::Change& change) {
  VirtualLights lights = scene.lights(change, kLightSeed);
  const Vec3f middle(-1, 0, 0);
  const auto nearer = [&](const SphericalLight& a, const SphericalLight& b) {
    return std::pair(a.depth, lengthSquared(a.p - middle)) <
           std::pair(b.depth, lengthSquared(b.p - middle));
  };
  if (lights.spherical.empty()) return lights;
  SphericalLight light =
      *std::min_element(lights.spherical.begin(), lights.spherical.end(), nearer);
  light.radius = kLargeRadius;
  light.coverage[0] = light.coverage[1] = ~0u;
  lights.spherical = {light};
  lights.sphericalDepthEnds.assign(size_t{light.depth} + 1, 0);
  lights.sphericalDepthEnds.back() = 1;
  return lights;
}

struct Sampling {
  const char *key, *label;
  SphereShading shading;
};
// The paper's ways draw up to 100 directions, by the cone; ours, by the lobes' overlap with it,
// which for lobes as narrow as these is one.
constexpr SphereShading sampled(SphereShading::Sampling sampling, int maxSamples) {
  return {SphereShading::Indicator::cosine, sampling, maxSamples};
}
constexpr Sampling kSamplings[] = {
    {"cone", "cone alone", sampled(SphereShading::Sampling::cone, 0)},
    {"mis", "cone and both BSDFs, balance heuristic", sampled(SphereShading::Sampling::paper, 0)},
    {"product", "products of lobes, our default", sampled(SphereShading::Sampling::product, 16)},
    {"product1000", "products of lobes, --vsl-samples 1000",
     sampled(SphereShading::Sampling::product, 1000)}};

// The same points in every picture, so that the integrals alone differ.
Film lightOf(BenchScene& scene, VirtualLights light, const SphereShading& shading,
             const BenchScene::Change& change) {
  light.sphereShading = shading;
  return scene.withLights(std::move(light), change, kEyeSeed, BenchScene::Extent::picture);
}

}  // namespace

void vslCorners(const BenchOptions& options, const VslSettings& settings, FigureReport& report,
                Context& context) {
  VslSettings few = settings;
  few.lights = std::min(few.lights, kCornerLights);
  few.columns = few.lights;  // all of them, that nothing but the lights' own errors be seen
  VslScene scene(options, few, "study-corners", context);
  const auto spheres = [](const char* indicator) {
    return [=](RenderOptions& o) { o.lights = "vsl", o.sphereIndicator = indicator; };
  };
  BenchTable& table = report.table({"figure4",
                                    "Figure 4: corners of a diffuse box, indirect light",
                                    {{"method", "method"},
                                     {"clamp", "clamp"},
                                     {"seconds", "seconds", "{:.2f}"},
                                     {"l2", "l2", "{:.3f}"},
                                     {"mean_ratio", "mean ratio", "{:.4f}"},
                                     {"picture", "picture"}},
                                    {},
                                    {fmt::format("{}, {} lights; spherical ones with the "
                                                 "automatic radius.",
                                                 scene.name(), few.lights)}});
  std::vector<FigurePicture> line;
  const auto save = [&](const std::string& key, const Film& film) {
    return report.picture("figure4-" + scene.stem() + "-" + key, film, scene.toneCurve());
  };
  for (const VslMethod& method : {scene.clamped("vpl", "VPL, best clamp"),
                                  VslMethod{"vsl-cosine", "VSL, cosine", spheres("cosine"), ""},
                                  VslMethod{"vsl-planar", "VSL, planar", spheres("planar"), ""}}) {
    const VslOutcome& outcome = scene.outcome(method);
    if (context.cancelled()) return;
    const std::string file = report.hasPictures() ? save(method.key, outcome.film) : "";
    line.push_back({method.label, file});
    table.rows.push_back({method.label, method.clamp, outcome.seconds, outcome.error.l2,
                          outcome.error.meanRatio, file});
  }
  if (report.hasPictures())
    line.push_back({"reference", save("reference", scene.referencePicture())});
  report.show("figure4", scene.name(), std::move(line));
}

void vslSampling(const BenchOptions& options, const VslSettings&, FigureReport& report,
                 Context& context) {
  BenchOptions own = options;
  own.scene.scene = "study-ward";
  BenchScene scene(own, {.scene = "study-ward"}, context);
  const auto change = [](RenderOptions& o) {
    o.lights = "vsl";
    o.specularLimit = kSpecularLimit;
    o.lightCount = kCandidates;
    o.spp = 1;
  };
  const std::string stage = std::string(kBenchStage) + "study-ward, sampling";
  context.progress(stage, 0);
  const VirtualLights light = oneLight(scene, change);
  const Film exact =
      lightOf(scene, light, sampled(SphereShading::Sampling::product, kExactSamples), change);
  if (context.cancelled()) return;
  const ToneCurve curve = measureToneCurve(exact, {});
  BenchTable& table = report.table(
      {"figure5",
       "Figure 5: one large spherical light, by each way of sampling",
       {{"sampling", "sampling"},
        {"noise", "relative noise", "{:.3f}"},
        {"mean_ratio", "mean ratio", "{:.4f}"},
        {"seconds", "seconds", "{:.2f}"},
        {"picture", "picture"}},
       {},
       {fmt::format("Radius {} in a box of half side 1; Ward of alpha 0.03 on all surfaces; cosine "
                    "indicator. Noise is the l2 of one evaluation per pixel from one of {} product "
                    "samples.",
                    kLargeRadius, kExactSamples)}});
  std::vector<FigurePicture> line;
  for (size_t i = 0; i < std::size(kSamplings); ++i) {
    context.progress(stage, (1.0 + static_cast<double>(i)) / (1 + std::size(kSamplings)));
    const int64_t start = nanosecondsNow();
    const Film film = lightOf(scene, light, kSamplings[i].shading, change);
    const double seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
    if (context.cancelled()) return;
    const Comparison error = compare(film, exact);
    const std::string file =
        report.picture(fmt::format("figure5-study-ward-{}", kSamplings[i].key), film, curve);
    line.push_back({kSamplings[i].label, file});
    table.rows.push_back({kSamplings[i].label, error.l2, error.meanRatio, seconds, file});
  }
  line.push_back({"exact", report.picture("figure5-study-ward-exact", exact, curve)});
  report.show("figure5", scene.name(), std::move(line));
}

}  // namespace lobelia::app
