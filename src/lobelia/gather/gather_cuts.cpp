#include "lobelia/gather/gather_cuts.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>

#include "lobelia/base/key_sort.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/chosen_gather.h"
#include "lobelia/gather/cut_recorder.h"
#include "lobelia/gather/receiver_clusters.h"

namespace lobelia::gather {
namespace {

uint64_t keyOf(const ReceiverPoint& point, uint64_t seed) {
  uint64_t key = hashCombine(seed, point.pixel);
  for (const float v : {point.p.x, point.p.y, point.p.z})
    key = hashCombine(key, std::bit_cast<uint32_t>(v));
  return key;
}

// Lights are looked for that make this share of a dominant one's: what the receivers get in all is
// told by few nodes then.
constexpr float kCandidateShare = 0.8f;
// One light of so many of a class shows whether a cluster's receivers see alike.
constexpr size_t kPilot = 16;

}  // namespace

// Some clusters: chooses the lights of all of them, then gathers these, so that neither the light
// trees nor what shadow rays meet goes out of the caches for every cluster.
class LightCuts::ClusterGather {
 public:
  ClusterGather(const LightCuts& cuts, const ReceiverClusters& clusters, GatherParts* parts)
      : cuts_(cuts),
        receivers_(clusters.receivers),
        gather_(cuts.tracer_, receivers_, clusters.order, cuts.lights_, cuts.prepared_,
                cuts.settings_.gather, parts) {}

  // As lights look for the cluster.
  ClusterTarget target(const ReceiverClusters::Cluster& cluster, uint64_t* evaluations) {
    constexpr size_t kNodes = 64;
    ClusterTarget target;
    target.receivers = cutReceivers(tileOf(cluster), receivers_);
    target.least = kCandidateShare * kDominant *
                   estimateAll(target.receivers, cluster.representatives, cuts_.trees_,
                               cuts_.settings_.cut, kNodes, &scratch_, evaluations);
    if (target.least > 0) target.representatives = cluster.representatives;
    return target;
  }

  // Chooses a cluster's lights. recorder: null where the cut is not kept.
  void choose(const ReceiverClusters::Cluster& cluster,
              std::span<const DominantLights::Leaf> dominant, GatherTally* tally,
              const CutRecorder* recorder, RecordedCut* record) {
    const int64_t start = nanosecondsNow();
    if (count_ == waiting_.size()) waiting_.emplace_back();
    Waiting& waiting = waiting_[count_++];
    waiting.tile = tileOf(cluster);
    waiting.seed = keyOf(receivers_.points[cluster.begin], cuts_.settings_.seed);
    tally->evaluations +=
        drawCutLights(cutReceivers(waiting.tile, receivers_), cluster.representatives, cuts_.trees_,
                      dominant, cuts_.settings_.cut, waiting.seed, &scratch_, &drawn_);
    if (recorder != nullptr) recorder->record(scratch_, drawn_, record);
    setLights(cluster.compact && cuts_.settings_.shared, &waiting.lights);
    tally->lights += waiting.lights.size();
    tally->clusteredLights += cuts_.numbers_.count();
    ++tally->clusters;
    if (scratch_.missed) ++tally->missed;
    tally->clusteredReceivers += cluster.end - cluster.begin;
    tally->traverseNs += nanosecondsNow() - start;
  }

  // Gathers what was chosen.
  void gather(std::span<Rgb> radiance, GatherTally* tally) {
    for (const Waiting& waiting : std::span(waiting_).first(count_))
      gather_.add(waiting.tile, waiting.lights, radiance, tally, waiting.seed);
    count_ = 0;
  }

 private:
  Tile tileOf(const ReceiverClusters::Cluster& cluster) const {
    Tile tile = makeTile(receivers_, cluster.begin, cluster.end);
    addSampling(receivers_, &tile);
    return tile;
  }

  // To what was drawn, in the order in which it is gathered.
  void setLights(bool share, std::vector<ChosenLight>* chosen) {
    chosen->clear();
    size_t sharing[std::size(kLightClasses)] = {};
    for (const CutLight& drawn : drawn_) {
      ChosenLight light = cuts_.numbers_.at(drawn.number);
      light.scale = Rgb(1 / drawn.probability);
      // A light that matters much alone casts its shadow sharply.
      if (share && drawn.share < kDominant)
        light.rays = sharing[static_cast<size_t>(light.lightClass)]++ % kPilot == 0
                         ? ChosenLight::Rays::pilot
                         : ChosenLight::Rays::shared;
      chosen->push_back(light);
    }
    order_.run(chosen, [](const ChosenLight& light) {
      return uint64_t{static_cast<uint8_t>(light.lightClass)} << 36 |
             uint64_t{static_cast<uint8_t>(light.rays)} << 32 | static_cast<uint32_t>(light.index);
    });
  }

  const LightCuts& cuts_;
  const Receivers& receivers_;
  ChosenGather gather_;
  CutScratch scratch_;
  std::vector<CutLight> drawn_;
  KeySort<ChosenLight> order_;
  struct Waiting {
    Tile tile;
    std::vector<ChosenLight> lights;
    uint64_t seed = 0;
  };
  std::vector<Waiting> waiting_;
  size_t count_ = 0;  // of them, the rest is memory to use again
};

LightCuts::LightCuts(const Tracer& tracer, const VirtualLights& lights,
                     const CutGatherSettings& settings, Context& context)
    : tracer_(tracer), lights_(lights), settings_(settings), numbers_(lights, settings.gather) {
  const StageTimer timer(context, "trees");
  const Bounds3f bounds = tracer.bounds();
  prepared_ = prepareLights(lights, tracer.scene());
  auto inputs = treeLights(lights, numbers_, tracer.scene(), bounds, prepared_);
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
  const auto gathered = [&](size_t i) {
    const ReceiverClusters::Cluster& cluster = clusters.clusters[i];
    return holdsPixel(clusters.receivers, cluster.begin, cluster.end, onlyPixel);
  };
  constexpr size_t kGrain = 32;
  DominantLights dominant;
  {
    const StageTimer timer(context, "traverse");
    std::vector<ClusterTarget> targets(clusters.clusters.size());
    std::atomic<uint64_t> evaluations = 0;
    parallelRanges(targets.size(), kGrain, [&](size_t begin, size_t end) {
      ClusterGather gather(*this, clusters, nullptr);
      uint64_t own = 0;
      for (size_t i = begin; i < end && !context.cancelled(); ++i)
        if (gathered(i)) targets[i] = gather.target(clusters.clusters[i], &own);
      evaluations += own;
    });
    dominant = DominantLights(targets, std::span(trees_).first(kDirectionalTree), context);
    context.statistics.addCount("node_pairs_visited", evaluations);
    context.statistics.addCount("dominant_lights", dominant.count());
    context.statistics.addCount("dominant_comparisons", dominant.comparisons());
  }
  std::optional<CutRecorder> recorder;
  std::vector<RecordedCut> records;
  if (parts != nullptr && parts->recordCuts) {
    recorder.emplace(trees_, numbers_.count());
    records = recordedReceivers(clusters);
  }
  gatherInParallel(
      clusters.clusters.size(), kGrain, context, [&](size_t begin, size_t end, GatherTally* tally) {
        ClusterGather gather(*this, clusters, ordered ? &*ordered : nullptr);
        for (size_t i = begin; i < end && !context.cancelled(); ++i)
          if (gathered(i))
            gather.choose(clusters.clusters[i], dominant.of(i), tally,
                          recorder ? &*recorder : nullptr, recorder ? &records[i] : nullptr);
        gather.gather(radiance, tally);
      });
  if (parts != nullptr) {
    parts->setOrdered(*ordered, clusters.order, points);
    parts->cuts = std::move(records);
  }
}

std::vector<ExportedTree> LightCuts::exportTrees() const {
  constexpr const char* kMeanings[kLightTrees] = {"lights that are mostly diffuse",
                                                  "lights that are mostly glossy",
                                                  "directional lights, as if far away"};
  std::vector<ExportedTree> trees;
  for (size_t t = 0; t < kLightTrees; ++t)
    trees.push_back(exportTree(trees_[t], numbers_, lights_, kMeanings[t]));
  return trees;
}

}  // namespace lobelia::gather
