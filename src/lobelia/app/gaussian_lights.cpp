#include "lobelia/app/gaussian_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobelia/app/vsgl_options.h"
#include "lobelia/base/random.h"
#include "lobelia/lights/filtered_sampling.h"
#include "lobelia/lights/light_order.h"
#include "lobelia/trees/gaussian_cut.h"

namespace lobelia::app {
namespace {

// What the extent of a map counts against the scene's size where centres are nearest.
constexpr float kMapWeight = 0.5f;
constexpr uint64_t kClusterStream = 0x7673676c;

using Points = std::vector<LightPoint>;

double powerOf(const Points& points) {
  return std::accumulate(points.begin(), points.end(), 0.0, [](double sum, const LightPoint& p) {
    return sum + static_cast<double>(p.power());
  });
}

// Points that may not be merged with others, one after the other.
std::vector<Points> apart(Points points, bool byDepth) {
  const auto key = [&](const LightPoint& p) {
    return std::pair(p.group, byDepth ? p.depth : std::min<uint16_t>(p.depth, 1));
  };
  sortByGroup(&points);
  std::vector<Points> kinds;
  for (const LightPoint& point : points) {
    if (kinds.empty() || key(kinds.back().front()) != key(point)) kinds.emplace_back();
    kinds.back().push_back(point);
  }
  return kinds;
}

bool inPairs(const RenderOptions& options) { return options.vsglClusters == "pairs"; }

bool byTree(const RenderOptions& options) {
  return options.vsglClusters.empty() || options.vsglClusters == "tree";
}

// Two lights of all points: what they scatter diffusely, and by Gaussians. Each is where its own
// power is.
std::vector<GaussianLight> lightsOfParts(const Points& points, bool toksvig, uint64_t seed) {
  std::vector<GaussianLight> lights;
  for (Rgb LightPoint::*const left : {&LightPoint::glossy, &LightPoint::diffuse}) {
    Points part;
    for (LightPoint point : points) {
      point.*left = Rgb{};
      if (point.power() > 0) part.push_back(point);
    }
    if (part.empty()) continue;
    std::vector<uint32_t> all(part.size());
    std::iota(all.begin(), all.end(), 0u);
    lights.push_back(clusterLight(part, all, toksvig, hashCombine(seed, lights.size())));
  }
  return lights;
}

// A cluster of few points stands for the surface around them: its places vary by a quarter of what
// those of all do in the mean, as trees have it by their parents (trees/gaussian_cut.cpp).
void widenSmall(std::vector<GaussianLight>* lights) {
  double sum = 0;
  for (const GaussianLight& light : *lights) sum += static_cast<double>(light.variance());
  const float least = static_cast<float>(0.25 * sum / static_cast<double>(lights->size()));
  for (GaussianLight& light : *lights) widen(least, &light);
}

// A run of points, as a map where they are one, and the lights that it is to have.
class Clustering {
 public:
  Clustering(const Tracer& tracer, const LightSettings& settings, const RenderOptions& options,
             uint64_t seed)
      : tracer_(tracer),
        options_(options),
        byDepth_(settings.maxDepth >= 0),
        seed_(hashCombine(seed, kClusterStream)) {}

  void addPoints(Points points) {
    for (Points& kind : apart(std::move(points), byDepth_)) add({0, std::move(kind)});
  }
  // Texels of several views have no square in common: they are ordered by place.
  void addMaps(ShadowMaps maps) {
    if (maps.maps.size() == 1 || inPairs(options_)) {
      for (ReflectiveShadowMap& map : maps.maps) add(std::move(map));
    } else {
      for (const ReflectiveShadowMap& map : maps.maps)
        maps.others.insert(maps.others.end(), map.texels.begin(), map.texels.end());
    }
    std::erase_if(maps.others, [](const LightPoint& p) { return !(p.power() > 0); });
    // In pairs, deeper light counts as that of the second bounce.
    for (Points& kind : apart(std::move(maps.others), byDepth_ && !inPairs(options_)))
      add({0, std::move(kind)});
  }

  std::vector<GaussianLight> lights(size_t count) {
    if (!inPairs(options_)) joinFaint(count);
    std::vector<GaussianLight> all;
    for (size_t i = 0; i < runs_.size(); ++i) {
      if (!(powers_[i] > 0)) continue;
      const size_t own =
          static_cast<size_t>(std::max(1.0, std::round(shareOf(i) * static_cast<double>(count))));
      const std::vector<GaussianLight> lights = cluster(runs_[i], own, hashCombine(seed_, i));
      all.insert(all.end(), lights.begin(), lights.end());
    }
    std::stable_sort(all.begin(), all.end(), [](const GaussianLight& a, const GaussianLight& b) {
      return a.depth < b.depth;
    });
    return all;
  }
  size_t pointCount() const {
    size_t count = 0;
    for (const ReflectiveShadowMap& run : runs_)
      count += static_cast<size_t>(std::count_if(
          run.texels.begin(), run.texels.end(), [](const LightPoint& p) { return p.power() > 0; }));
    return count;
  }

 private:
  double shareOf(size_t run) const { return total_ > 0 ? powers_[run] / total_ : 0; }

  // Depths that would have less than half a light are told as the one before them: where few lights
  // are asked for, deep light counts as a little less deep.
  void joinFaint(size_t count) {
    const auto first = [&](size_t i) -> const LightPoint& { return runs_[i].texels.front(); };
    for (size_t i = runs_.size(); i-- > 1;) {
      const bool faint = shareOf(i) * static_cast<double>(count) < 0.5;
      if (!faint || runs_[i].size > 0 || runs_[i - 1].size > 0 || first(i - 1).depth == 0 ||
          first(i).group != first(i - 1).group)
        continue;
      Points& before = runs_[i - 1].texels;
      const uint16_t depth = first(i - 1).depth;
      for (LightPoint point : runs_[i].texels) {
        point.depth = depth;
        before.push_back(point);
      }
      runs_[i].texels.clear();
      powers_[i - 1] += powers_[i];
      powers_[i] = 0;
    }
  }

  void add(ReflectiveShadowMap run) {
    powers_.push_back(powerOf(run.texels));
    total_ += powers_.back();
    runs_.push_back(std::move(run));
  }

  std::vector<GaussianLight> cluster(const ReflectiveShadowMap& run, size_t wanted,
                                     uint64_t seed) const {
    const bool toksvig = options_.vsglMerging == "toksvig";
    if (inPairs(options_)) return lightsOfParts(run.texels, toksvig, seed);
    if (run.size == 0 && !byTree(options_))
      return cluster(mapOfPoints(run.texels, tracer_.bounds()), wanted, seed);
    const size_t count = std::min(wanted, run.texels.size());
    const float scale = 2 * std::max(tracer_.bounds().radius(), 1e-6f);
    if (byTree(options_)) return trees::cutLights(run.texels, count, scale, toksvig, seed);
    if (options_.vsglClusters == "kmeans") {
      const Clusters clusters = nearestCentres(run.texels, count, scale, run.size,
                                               run.inOrderOfPlace ? 0 : kMapWeight, seed);
      std::vector<GaussianLight> lights = clusterLights(run.texels, clusters, toksvig, seed);
      widenSmall(&lights);
      return lights;
    }
    FilteredSampling sampling;
    sampling.count = count;
    if (options_.vsglOverlap > 0) sampling.overlap = options_.vsglOverlap;
    sampling.level = options_.vsglClusters == "fis" ? FilteredSampling::Level::bisection
                                                    : FilteredSampling::Level::original;
    sampling.toksvig = toksvig;
    sampling.seed = seed;
    return filteredLights(run, sampling);
  }

  const Tracer& tracer_;
  const RenderOptions& options_;
  const bool byDepth_;
  const uint64_t seed_;
  std::vector<ReflectiveShadowMap> runs_;  // of size 0: in no order
  std::vector<double> powers_;
  double total_ = 0;
};

std::vector<uint32_t> depthEnds(const std::vector<GaussianLight>& lights) {
  std::vector<uint32_t> ends;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    ends.resize(std::max<size_t>(ends.size(), lights[i].depth + size_t{1}), i);
    ends[lights[i].depth] = i + 1;
  }
  return ends;
}

void finish(Clustering& clustering, const LightSettings& settings, const RenderOptions& options,
            VirtualLights* lights) {
  lights->gaussian = clustering.lights(settings.count);
  lights->gaussianDepthEnds = depthEnds(lights->gaussian);
  lights->gaussianShading = gaussianShadingOf(options);
}

}  // namespace

VirtualLights makeGaussianLights(const Tracer& tracer, const EmitterSampler& emitters,
                                 const LightSettings& settings, const RenderOptions& options,
                                 Context& context) {
  VirtualLights lights = emitterLights(emitters, settings, context);
  const uint64_t before = context.statistics.count("light_particles");
  LightSettings pointSettings = settings;
  pointSettings.count = vsglPointsOf(options, inPairs(options) ? 2 : settings.count);
  Clustering clustering(tracer, settings, options, lights.seed);
  if (byTree(options)) {
    clustering.addPoints(makeLightPoints(tracer, emitters, pointSettings, context));
  } else {
    size_t views = options.vsglViews;
    if (inPairs(options) && views == 0) views = std::max<size_t>(tracer.scene().emitters.size(), 1);
    clustering.addMaps(
        makeShadowMaps(tracer, emitters, pointSettings, {pointSettings.count, views}, context));
  }
  if (context.cancelled()) return lights;
  const StageTimer timer(context, "lights");
  finish(clustering, settings, options, &lights);
  lights.particles = context.statistics.count("light_particles") - before;
  const size_t points = clustering.pointCount();
  context.statistics.addCount("light_points", points);
  context.debug(fmt::format("{} point lights in {} clusters", points, lights.gaussian.size()));
  return lights;
}

void addClusters(const Tracer& tracer, ShadowMaps maps, const LightSettings& settings,
                 const RenderOptions& options, VirtualLights* lights) {
  Clustering clustering(tracer, settings, options, lights->seed);
  if (byTree(options)) {
    Points all = std::move(maps.others);
    for (const ReflectiveShadowMap& map : maps.maps)
      all.insert(all.end(), map.texels.begin(), map.texels.end());
    clustering.addPoints(std::move(all));
  } else {
    clustering.addMaps(std::move(maps));
  }
  finish(clustering, settings, options, lights);
}

}  // namespace lobelia::app
