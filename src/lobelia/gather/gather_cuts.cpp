#include "lobelia/gather/gather_cuts.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/receiver_clusters.h"
#include "lobelia/gather/tile_parts.h"

namespace lobelia::gather {
namespace {

uint64_t keyOf(const ReceiverPoint& point, uint64_t seed) {
  uint64_t key = hashCombine(seed, point.pixel);
  for (const float v : {point.p.x, point.p.y, point.p.z})
    key = hashCombine(key, std::bit_cast<uint32_t>(v));
  return key;
}

// A light that makes at least this share of what a cluster gets casts its shadow sharply: each
// receiver has its own ray to it.
constexpr float kOwnRays = 0.005f;

}  // namespace

struct LightCuts::Tally {
  uint64_t rays = 0, pairs = 0, nonfinite = 0, evaluations = 0, lights = 0;
  std::optional<uint32_t> firstBad;  // the smallest pixel with a pair that was not finite
  int64_t traverseNs = 0, visibilityNs = 0, shadeNs = 0;
};

// One cluster after the other.
class LightCuts::ClusterGather {
 public:
  ClusterGather(const LightCuts& cuts, const ReceiverClusters& clusters, GatherParts* parts)
      : cuts_(cuts), clusters_(clusters), parts_(parts) {}

  void run(const ReceiverClusters::Cluster& cluster, std::span<Rgb> radiance, Tally* tally) {
    const int64_t start = nanosecondsNow();
    Tile tile = makeTile(clusters_.receivers, cluster.begin, cluster.end);
    addSampling(clusters_.receivers, &tile);
    const uint64_t seed = keyOf(clusters_.receivers.points[cluster.begin], cuts_.settings_.seed);
    const CutReceivers receivers = cutReceivers(tile, clusters_.receivers);
    tally->evaluations += drawCutLights(receivers, cluster.representatives, cuts_.trees_,
                                        cuts_.settings_.cut, seed, &scratch_, &drawn_);
    tally->lights += drawn_.size();
    tally->traverseNs += nanosecondsNow() - start;

    TileSums sums;
    sums.strips.resize(1);
    std::optional<TileParts> parts;
    if (parts_ != nullptr) parts.emplace(clusters_.receivers, cuts_.lights_, tile, parts_);
    TileParts* const part = parts ? &*parts : nullptr;
    for (const LightClass lightClass : kLightClasses) {
      if (parts) parts->beginClass(sums);
      // What its lights share, then what they do not.
      if (shares(cluster)) addClass(tile, lightClass, true, cluster, seed, &sums, part, tally);
      addClass(tile, lightClass, false, cluster, seed, &sums, part, tally);
      if (parts) parts->endClass(lightClass, sums);
    }
    if (parts) parts->write();
    tally->pairs += sums.pairs;
    tally->nonfinite += sums.nonfinite;
    write(tile.strips[0], sums.strips[0], radiance, tally);
  }

 private:
  bool shares(const ReceiverClusters::Cluster& cluster) const {
    return cluster.compact && cuts_.settings_.shared;
  }

  // Lights of a class: those that one ray answers for, or those that need a ray from each receiver.
  void addClass(const Tile& tile, LightClass lightClass, bool shared,
                const ReceiverClusters::Cluster& cluster, uint64_t seed, TileSums* sums,
                TileParts* parts, Tally* tally) {
    uint32_t indices[kBlockLights];
    float scale[kBlockLights];
    size_t count = 0;
    const auto flush = [&] {
      if (count == 0) return;
      addBlock(tile, lightClass, {indices, count}, scale, shared,
               hashCombine(hashCombine(seed, static_cast<uint64_t>(lightClass)), indices[0]), sums,
               parts, tally);
      count = 0;
    };
    for (const CutLight& drawn : drawn_) {
      const ChosenLight light = cuts_.numbers_.at(drawn.number);
      if (light.lightClass != lightClass) continue;
      if (shared != (shares(cluster) && drawn.share < kOwnRays)) continue;
      indices[count] = static_cast<uint32_t>(light.index);
      scale[count++] = 1 / drawn.probability;
      if (count == kBlockLights) flush();
    }
    flush();
  }

  void addBlock(const Tile& tile, LightClass lightClass, std::span<const uint32_t> indices,
                const float* scale, bool shared, uint64_t seed, TileSums* sums, TileParts* parts,
                Tally* tally) {
    const CutGatherSettings& settings = cuts_.settings_;
    const int64_t start = nanosecondsNow();
    prepareChosen(cuts_.lights_, cuts_.tracer_.scene(), lightClass, indices, &block_,
                  cuts_.spheres_);
    for (size_t i = 0; i < indices.size(); ++i) block_.lights[i].intensity *= scale[i];
    allowPairs(tile, block_, cuts_.lights_, settings.gather, &pairs_);
    if (parts != nullptr) parts->watchRays(&pairs_);
    const int64_t prepared = nanosecondsNow();
    tally->rays += shared ? keepVisibleByOne(tile, block_, cuts_.tracer_, seed, &pairs_)
                          : keepVisible(tile, block_, cuts_.tracer_, &pairs_);
    const int64_t traced = nanosecondsNow();
    shade(tile, block_, settings.gather.clamp, pairs_, sums);
    if (parts != nullptr) parts->add(block_, settings.gather.clamp, pairs_);
    tally->traverseNs += prepared - start;
    tally->visibilityNs += traced - prepared;
    tally->shadeNs += nanosecondsNow() - traced;
  }

  void write(const PointStrip& strip, const TileSums::Strip& sum, std::span<Rgb> radiance,
             Tally* tally) const {
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(strip.active >> lane & 1)) continue;
      const size_t i = strip.point[lane];
      const ReceiverPoint& point = clusters_.receivers.points[i];
      radiance[clusters_.order[i]] +=
          point.weight * Rgb(static_cast<float>(sum.x[lane]), static_cast<float>(sum.y[lane]),
                             static_cast<float>(sum.z[lane]));
      if ((sum.nonfinite >> lane & 1) != 0 && (!tally->firstBad || point.pixel < *tally->firstBad))
        tally->firstBad = point.pixel;
    }
  }

  const LightCuts& cuts_;
  const ReceiverClusters& clusters_;
  GatherParts* parts_;
  CutScratch scratch_;
  std::vector<CutLight> drawn_;
  LightBlock block_;
  PairMasks pairs_;
};

LightCuts::LightCuts(const Tracer& tracer, const VirtualLights& lights,
                     const CutGatherSettings& settings, Context& context)
    : tracer_(tracer), lights_(lights), settings_(settings), numbers_(lights, settings.gather) {
  const StageTimer timer(context, "trees");
  const Bounds3f bounds = tracer.bounds();
  spheres_ = prepareSpheres(lights, tracer.scene());
  auto inputs = treeLights(lights, numbers_, tracer.scene(), bounds, spheres_);
  for (size_t t = 0; t < kLightTrees && !context.cancelled(); ++t) {
    trees_[t] = trees::LightTree(inputs[t].lights, inputs[t].numbers, 2 * bounds.radius());
    inputs[t] = {};
  }
}

void LightCuts::gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
                       Context& context, GatherParts* parts) const {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument("LightCuts::gather: one radiance value per receiver point");
  ReceiverClusters clusters;
  {
    const StageTimer timer(context, "traverse");
    clusters = clusterReceivers(receivers, 2 * tracer_.bounds().radius(), settings_.width);
  }
  std::optional<GatherParts> ordered;  // by the clusters' order
  if (parts != nullptr) {
    ordered = *parts;
    ordered->reset(clusters.order.size());
  }
  Tally all;
  std::mutex mutex;
  std::atomic<size_t> done{0};
  constexpr size_t kGrain = 8;
  parallelRanges(clusters.clusters.size(), kGrain, [&](size_t begin, size_t end) {
    ClusterGather gather(*this, clusters, ordered ? &*ordered : nullptr);
    Tally tally;
    for (size_t i = begin; i < end; ++i) {
      if (context.cancelled()) return;
      const ReceiverClusters::Cluster& cluster = clusters.clusters[i];
      if (!holdsPixel(clusters.receivers, cluster.begin, cluster.end, onlyPixel)) continue;
      gather.run(cluster, radiance, &tally);
    }
    const std::lock_guard lock(mutex);
    all.rays += tally.rays, all.pairs += tally.pairs, all.nonfinite += tally.nonfinite;
    all.evaluations += tally.evaluations, all.lights += tally.lights;
    all.traverseNs += tally.traverseNs, all.visibilityNs += tally.visibilityNs;
    all.shadeNs += tally.shadeNs;
    if (tally.firstBad) noteNonFinitePixel(*tally.firstBad, context);
    done += end - begin;
    context.progress("gather",
                     static_cast<double>(done) / static_cast<double>(clusters.clusters.size()));
  });
  if (parts != nullptr) parts->setOrdered(*ordered, clusters.order, points);
  const double toSeconds = 1e-9 / threadCount();
  context.statistics.addCount("shadow_rays", all.rays);
  context.statistics.addCount("node_pairs_visited", all.evaluations);
  context.statistics.addCount("node_pairs_shaded", all.pairs);
  context.statistics.addCount("cut_lights", all.lights);
  context.statistics.addCount("receiver_clusters", clusters.clusters.size());
  context.statistics.addCount("clustered_lights", numbers_.count() * clusters.clusters.size());
  context.statistics.addCount("clustered_receivers", clusters.order.size());
  context.statistics.addCount("nonfinite", all.nonfinite);
  context.statistics.addSeconds("traverse", static_cast<double>(all.traverseNs) * toSeconds);
  context.statistics.addSeconds("visibility", static_cast<double>(all.visibilityNs) * toSeconds);
  context.statistics.addSeconds("shade", static_cast<double>(all.shadeNs) * toSeconds);
}

}  // namespace lobelia::gather
