// The same texels of reflective shadow maps clustered in several ways, one bounce of light: error
// against the light of all texels, and against the path tracer.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/app/bench_vsgl.h"
#include "lobelia/app/gaussian_lights.h"
#include "lobelia/app/light_sets.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kPixels = 1000;
constexpr size_t kTexels = size_t{1} << 16;
constexpr int kEyeSamples = 4;
constexpr size_t kCounts[] = {2, 4, 16, 64, 256, 1024, 4096};
constexpr int kOneBounce = 3;
constexpr uint64_t kRuns = 4;  // of a way and a number: l2 are root mean squares, ratios means

struct Way {
  const char *key, *label;
  bool points = false;  // what stands for a cluster is a point light
};
constexpr Way kWays[] = {{"fis-original", "sampling, original"},
                         {"fis", "sampling, bisection"},
                         {"kmeans", "k-means"},
                         {"tree", "tree cut"},
                         {"tree", "tree cut, point lights", true}};

// Plain representatives: the light of a cluster from the place nearest to its mean.
VirtualLights representatives(const VirtualLights& clusters) {
  std::vector<LightPoint> points;
  for (const GaussianLight& light : clusters.gaussian) {
    LightPoint point;
    point.p = light.places[0].p;
    point.n = decodeOctahedral(light.places[0].normal);
    point.diffuse = light.diffuse, point.glossy = light.glossy;
    point.axis = light.axis, point.sharpness = light.sharpness;
    point.group = light.group, point.depth = light.depth;
    points.push_back(point);
  }
  VirtualLights out = clusters;
  out.gaussian.clear(), out.gaussianDepthEnds.clear();
  addPointLights(points, &out);
  return out;
}

class Sampling {
 public:
  Sampling(const std::string& name, const VsglStudy& study)
      : study_(study),
        scene_(sceneOptions(name, study), {.scene = name, .pixels = kPixels, .width = 400},
               study.context) {
    options_.maxDepth = scene_.maxDepth();
    settings_ = lightSettings(options_, scene_.maxDepth(), 0);
    settings_.count = study.options.lightCount > 0 ? study.options.lightCount : kTexels;
  }

  void run() {
    study_.progress(scene_, "path tracer");
    path_ = pathReference(scene_, study_.pathSamples, kVsglReferenceSeed, study_.context);
    maps_ = makeShadowMaps(scene_.tracer(), scene_.emitters(), settings_, {settings_.count, 0},
                           study_.context);
    if (study_.cancelled()) return;
    addTexels();
    for (const Way& way : kWays)
      for (const size_t count : kCounts) {
        study_.progress(scene_, fmt::format("{}, {} lights", way.label, count));
        if (!study_.cancelled()) add(way, count);
      }
    showPictures();
  }

 private:
  static BenchOptions sceneOptions(const std::string& name, const VsglStudy& study) {
    BenchOptions options = study.options;
    options.scene.scene = name;
    if (options.maxDepth == 0) options.maxDepth = kOneBounce;
    return options;
  }

  BenchTable& table() {
    return study_.report.table(
        {"sampling",
         "Ways of clustering texels: error by number of lights",
         {{"scene", "scene"},
          {"clusters", "clusters"},
          {"wanted", "asked for", "{:.0f}"},
          {"lights", "lights", "{:.0f}"},
          {"make", "made in s", "{:.2f}"},
          {"gather", "gathered in s", "{:.2f}"},
          {"l2", "l2, all texels", "{:.3f}"},
          {"mean_ratio", "mean ratio", "{:.4f}"},
          {"l2_path", "l2, path tracer", "{:.3f}"},
          {"ratio_path", "mean ratio", "{:.4f}"}},
         {},
         {fmt::format(
             "One bounce (--max-depth {}), {} pixels, {} eye samples, a shadow ray to every light; "
             "of {} runs. l2 against the same gathered from all texels as point lights, and "
             "against "
             "path tracing, two halves of {} samples.",
             scene_.maxDepth(), scene_.pixelCount(), kEyeSamples, kRuns, study_.pathSamples / 2)}});
  }

  static BenchScene::Change change(bool gaussian) {
    return [gaussian](RenderOptions& options) {
      options.lights = gaussian ? "vsgl" : "glossy";
      options.clamp = "off";
      options.spp = kEyeSamples;
    };
  }

  VirtualLights header() const {
    return emitterLights(scene_.emitters(), settings_, study_.context);
  }

  void addTexels() {
    VirtualLights all = header();
    std::vector<LightPoint> points = maps_.others;
    for (const ReflectiveShadowMap& map : maps_.maps)
      points.insert(points.end(), map.texels.begin(), map.texels.end());
    addPointLights(points, &all);
    const double count = static_cast<double>(all.size());
    const Spent spent(study_.context);
    all_ = scene_.withLights(std::move(all), change(false), kVsglSeed, BenchScene::Extent::pixels);
    if (study_.cancelled()) return;
    const Comparison path = compare(all_, path_.first, &path_.second);
    const double none = std::nan("");
    table().rows.push_back({scene_.name(), "all texels", none, count, none, spent.total(), none,
                            none, path.l2, path.meanRatio});
  }

  VirtualLights clustered(const Way& way, size_t count, uint64_t run = 0) const {
    VirtualLights lights = header();
    lights.seed = hashCombine(lights.seed, run);
    LightSettings settings = settings_;
    settings.count = count;
    RenderOptions options = options_;
    options.vsglClusters = way.key;
    addClusters(scene_.tracer(), maps_, settings, options, &lights);
    return way.points ? representatives(lights) : lights;
  }

  void add(const Way& way, size_t count) {
    double made = 0, make = 0, gather = 0, texels[2] = {}, path[2] = {};
    for (uint64_t run = 0; run < kRuns && !study_.cancelled(); ++run) {
      const Spent making(study_.context);
      VirtualLights lights = clustered(way, count, run);
      make += making.total() / kRuns;
      const size_t lightCount = way.points ? std::max(lights.diffuse.size(), lights.glossy.size())
                                           : lights.gaussian.size();
      made += static_cast<double>(lightCount) / kRuns;
      const Spent gathering(study_.context);
      const Film film = scene_.withLights(std::move(lights), change(!way.points), kVsglSeed,
                                          BenchScene::Extent::pixels);
      gather += gathering.total() / kRuns;
      const auto note = [](const Comparison& error, double* sums) {
        sums[0] += error.l2 * error.l2 / kRuns, sums[1] += error.meanRatio / kRuns;
      };
      if (study_.cancelled()) return;
      note(compare(film, all_), texels);
      note(compare(film, path_.first, &path_.second), path);
    }
    if (study_.cancelled()) return;
    table().rows.push_back({scene_.name(), way.label, static_cast<double>(count), made, make,
                            gather, std::sqrt(texels[0]), texels[1], std::sqrt(path[0]), path[1]});
  }

  // What clusters do to a picture: 64 lights by each way, and the path tracer.
  void showPictures() {
    if (!study_.report.hasPictures() || study_.cancelled()) return;
    constexpr size_t kShown = 64;
    const Film path = scene_.pathTraced(64, kVsglReferenceSeed, BenchScene::Extent::picture);
    const ToneCurve curve = measureToneCurve(path, {});
    std::vector<FigurePicture> line;
    const std::string stem = "sampling-" + study_.stem(scene_);
    for (const Way& way : kWays) {
      if (study_.cancelled()) return;
      const Film film = scene_.withLights(clustered(way, kShown), change(!way.points), kVsglSeed,
                                          BenchScene::Extent::picture);
      const std::string key = way.points ? "points" : way.key;
      line.push_back({way.label, study_.report.picture(stem + "-" + key, film, curve)});
    }
    line.push_back({"path tracer", study_.report.picture(stem + "-path", path, curve)});
    study_.report.show("sampling", fmt::format("{}: {} lights", study_.stem(scene_), kShown),
                       std::move(line));
  }

  const VsglStudy& study_;
  BenchScene scene_;
  RenderOptions options_;
  LightSettings settings_;
  Reference path_;
  ShadowMaps maps_;
  Film all_;
};

}  // namespace

void vsglSampling(const std::string& scene, const VsglStudy& study) {
  Sampling(scene, study).run();
}

}  // namespace lobelia::app
