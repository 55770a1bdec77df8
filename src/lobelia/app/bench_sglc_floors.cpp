// What gathering would take at the bare rates of its parts, measured in the same run: shadow rays
// by Embree alone (trace/bare_rays.h), pairs by the shading kernel alone, and the bounds of pairs
// of nodes (mode paper) or the estimates of nodes (the other modes) by their kernel alone. Rays and
// pairs are those of sampled clusters of neighbouring receivers and of lights drawn for each by its
// cut: a ray from every receiver of a cluster to one light after another, and where one answers for
// the cluster (mode shared) from one of its receivers to each light; lights of a class in their
// order in the scene. All clusters and all drawn lights are asked for both: those that have rays of
// their own in mode shared, clusters at edges among them, cost more than the floor says. Trees are
// built apart.
//
// The search for dominant lights has no floor: the ratios of modes shared and unbiased are upper
// limits.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "lobelia/app/bench_rays.h"
#include "lobelia/app/bench_sglc.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/light_forest.h"
#include "lobelia/gather/node_bounds.h"
#include "lobelia/gather/receiver_clusters.h"
#include "lobelia/gather/receiver_forest.h"
#include "lobelia/gather/tree_lights.h"

namespace lobelia::app {
namespace {

using namespace gather;

constexpr uint64_t kStream = 0x666c6f6f;
constexpr size_t kClusters = 512, kBoundPairs = 1 << 16, kBoundBatch = 512, kBoundRun = 64;
constexpr int kEstimateRuns = 64;  // for a cluster
constexpr int kTurns = 3;
constexpr double kLeastSeconds = 0.2;  // of a loop that is timed
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// How much f() gets done, which it returns, per second of the clock: the best of some turns, as
// other programs on a machine come and go.
template <class F>
double ratePerSecond(const F& f) {
  double best = 0, all = 0;
  for (int turn = 0; turn < kTurns || all < kLeastSeconds; ++turn) {
    const int64_t start = nanosecondsNow();
    const double done = f();
    const double seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
    if (done == 0) return kNone;
    best = std::max(best, done / seconds);
    all += seconds;
  }
  return best;
}

struct Block {  // some lights of a cluster, and what sees them
  LightBlock lights;
  PairMasks visible;
};
struct Sample {
  Tile tile;
  CutReceivers receivers;
  int representatives = 1;
  std::vector<Block> blocks;
  std::vector<ShadowPacket> rays, sharedRays;
};

// Lights as a cut draws them for clusters spread over the picture.
class Samples {
 public:
  Samples(const Tracer& tracer, const VirtualLights& lights, const Receivers& receivers,
          const GatherSettings& settings, int width)
      : tracer_(tracer), lights_(lights), settings_(settings), numbers_(lights, settings) {
    const Bounds3f bounds = tracer.bounds();
    clusters_ = clusterReceivers(receivers, 2 * bounds.radius(), width);
    auto inputs = treeLights(lights, numbers_, tracer.scene(), bounds, {});
    for (size_t t = 0; t < kLightTrees; ++t)
      trees_[t] = trees::LightTree(inputs[t].lights, inputs[t].numbers, 2 * bounds.radius());
    const size_t all = clusters_.clusters.size(), count = std::min(all, kClusters);
    samples_.resize(count);
    parallelFor(count, 1,
                [&](size_t i) { fill(clusters_.clusters[i * all / count], &samples_[i]); });
  }

  // Of every receiver, or shared ones.
  double rays(const BareRays& bare, bool shared) const {
    return ratePerSecond([&] {
      std::atomic<uint64_t> rays{0}, visible{0};
      parallelFor(samples_.size(), 1, [&](size_t i) {
        const auto& packets = shared ? samples_[i].sharedRays : samples_[i].rays;
        visible += bare.visible(packets, !shared);
        rays += packets.size() * ShadowPacket::kSize;
      });
      return static_cast<double>(rays);
    });
  }
  double shadings() const {
    return ratePerSecond([&] {
      std::atomic<uint64_t> pairs{0};
      parallelFor(samples_.size(), 1, [&](size_t i) {
        TileSums sums;
        sums.strips.resize(samples_[i].tile.strips.size());
        for (const Block& block : samples_[i].blocks)
          shade(samples_[i].tile, block.lights, settings_.clamp, block.visible, &sums);
        pairs += sums.pairs;
      });
      return static_cast<double>(pairs);
    });
  }

  // Of runs of neighbouring nodes.
  double estimates() const {
    std::vector<const trees::LightTree*> trees;
    for (const trees::LightTree& tree : trees_)
      if (!tree.empty()) trees.push_back(&tree);
    return ratePerSecond([&] {
      std::atomic<uint64_t> nodes{0};
      parallelFor(samples_.size(), 1, [&](size_t i) {
        Rng rng(hashCombine(kStream, i));
        for (int run = 0; run < kEstimateRuns; ++run) {
          const auto all = trees[rng.nextUint() % trees.size()]->nodes();
          const size_t first = rng.nextUint() % all.size();
          const size_t count = std::min(kBoundRun, all.size() - first);
          const trees::LightNode* some[kBoundRun];
          float values[kBoundRun];
          for (size_t n = 0; n < count; ++n) some[n] = &all[first + n];
          estimateNodes(samples_[i].receivers, samples_[i].representatives, CutSettings().floor,
                        {some, count}, values);
          nodes += count;
        }
      });
      return static_cast<double>(nodes);
    });
  }

 private:
  void fill(const ReceiverClusters::Cluster& cluster, Sample* sample) const {
    sample->tile = makeTile(clusters_.receivers, cluster.begin, cluster.end);
    addSampling(clusters_.receivers, &sample->tile);
    CutScratch scratch;
    std::vector<CutLight> drawn;
    sample->receivers = cutReceivers(sample->tile, clusters_.receivers);
    sample->representatives = cluster.representatives;
    drawCutLights(sample->receivers, sample->representatives, trees_, {}, CutSettings(),
                  hashCombine(kStream, cluster.begin), &scratch, &drawn);
    for (const LightClass lightClass : kLightClasses) {
      std::vector<uint32_t> indices;
      for (const CutLight& light : drawn) {
        const ChosenLight chosen = numbers_.at(light.number);
        if (chosen.lightClass == lightClass) indices.push_back(static_cast<uint32_t>(chosen.index));
      }
      std::sort(indices.begin(), indices.end());  // as they are gathered
      for (size_t first = 0; first < indices.size(); first += kBlockLights) {
        const size_t count = std::min(kBlockLights, indices.size() - first);
        addBlock(lightClass, std::span(indices).subspan(first, count), sample);
      }
    }
    addRays(cluster, sample);
  }

  void addBlock(LightClass lightClass, std::span<const uint32_t> indices, Sample* sample) const {
    Block& block = sample->blocks.emplace_back();
    prepareChosen(lights_, tracer_.scene(), lightClass, indices, &block.lights);
    allowPairs(sample->tile, block.lights, lights_, settings_, &block.visible);
    keepVisible(sample->tile, block.lights, tracer_, &block.visible);
  }

  // Of diffuse and glossy lights, as bench rates has them.
  void addRays(const ReceiverClusters::Cluster& cluster, Sample* sample) const {
    std::vector<PointNormal> ends;
    for (const Block& block : sample->blocks) {
      const LightClass lightClass = block.lights.lightClass;
      if (lightClass != LightClass::diffuse && lightClass != LightClass::glossy) continue;
      for (int i = 0; i < block.lights.count; ++i)
        ends.push_back({block.lights.lights[i].end, block.lights.lights[i].n});
    }
    const auto points =
        std::span(clusters_.receivers.points).subspan(cluster.begin, cluster.end - cluster.begin);
    sample->rays = tileToLights(points, ends);
    if (cluster.compact)
      sample->sharedRays = oneToEachLight(points, ends, hashCombine(kStream, cluster.begin));
  }

  const Tracer& tracer_;
  const VirtualLights& lights_;
  const GatherSettings settings_;
  const LightNumbers numbers_;
  ReceiverClusters clusters_;
  trees::LightTree trees_[kLightTrees];
  std::vector<Sample> samples_;
};

// Random nodes of receivers to runs of neighbouring nodes of lights, of the trees of each pairing.
double boundsPerSecond(const Tracer& tracer, const VirtualLights& lights,
                       const Receivers& receivers, const GatherSettings& settings) {
  const Bounds3f bounds = tracer.bounds();
  const ReceiverForest receiverForest =
      plantReceivers(receivers, 2 * bounds.radius(), false, false);
  const LightForest lightForest = plantLights(lights, settings, 0, tracer.scene(), bounds, {});
  struct Pairing {
    LightClass lightClass;
    bool glossy;
    std::vector<NodePair> pairs;
  };
  std::vector<Pairing> pairings;
  Rng rng(kStream);
  const size_t count =
      kBoundPairs / std::max<size_t>(1, receiverForest.trees.size() * lightForest.trees.size()) + 1;
  for (const auto& receiverTree : receiverForest.trees) {
    for (const auto& lightTree : lightForest.trees) {
      if (lightTree.apart) continue;
      Pairing& pairing = pairings.emplace_back();
      pairing.lightClass = lightTree.lightClass;
      pairing.glossy = receiverTree.glossy;
      const auto to = receiverTree.tree.nodes(), from = lightTree.tree.nodes();
      while (pairing.pairs.size() < count) {
        const trees::BoundNode& receiver = to[rng.nextUint() % to.size()];
        const size_t first = rng.nextUint() % from.size();
        for (size_t i = first; i < std::min(first + kBoundRun, from.size()); ++i)
          pairing.pairs.push_back({&receiver, &from[i]});
      }
    }
  }
  return ratePerSecond([&] {
    double done = 0;
    for (const Pairing& pairing : pairings) {
      parallelRanges(pairing.pairs.size(), kBoundBatch, [&](size_t begin, size_t end) {
        std::vector<PairBounds> out(end - begin);
        boundPairs(std::span(pairing.pairs).subspan(begin, end - begin), pairing.lightClass,
                   pairing.glossy, BoundForm::tight, out.data());
      });
      done += static_cast<double>(pairing.pairs.size());
    }
    return done;
  });
}

bool isPaper(const SglcMethod& method) { return method.key == approximateMethod().key; }

BenchTable emptyTable() {
  return {
      "floors",
      "Gathering against the floors of its parts",
      {{"scene", "scene"},
       {"method", "method"},
       {"mrays_per_second", "bare rays, M/s", "{:.1f}"},
       {"shared_mrays_per_second", "shared ones, M/s", "{:.1f}"},
       {"mshadings_per_second", "bare shading, M pairs/s", "{:.1f}"},
       {"mbounds_per_second", "bare bounds or estimates, M/s", "{:.1f}"},
       {"ray_floor", "seconds: rays", "{:.2f}"},
       {"shade_floor", "shading", "{:.2f}"},
       {"bound_floor", "bounds or estimates", "{:.2f}"},
       {"seconds_without_trees", "gather without trees", "{:.2f}"},
       {"ratio", "over the floors", "{:.2f}"}},
      {},
      {"Rates on all threads by the clock, the best of some turns. Bounds of pairs of nodes in "
       "mode "
       "paper, estimates of nodes in the others; their search for dominant lights has no floor. "
       "Rays: from each receiver of a cluster to one light after another; those that stand for a "
       "whole cluster, each to another light, by a rate of their own. Trees are built apart."}};
}

}  // namespace

void sglcFloors(SglcScene& scene, FigureReport& report, Context& context) {
  std::vector<const SglcOutcome*> outcomes;
  std::vector<SglcMethod> methods;
  for (const SglcMethod& method : sglcMethods(scene.settings())) {
    if (!method.key.starts_with("sglc")) continue;
    methods.push_back(method);
    outcomes.push_back(&scene.outcome(method));
    if (context.cancelled()) return;
  }
  scene.progress("floors");
  const Tracer& tracer = scene.scene().tracer();
  const auto [receivers, settings] = scene.receivers();
  if (context.cancelled() || receivers.points.empty() || scene.lights().size() == 0) return;
  const Samples samples(tracer, scene.lights(), receivers, settings,
                        scene.scene().camera().cropX1 - scene.scene().camera().cropX0);
  const BareRays bare(tracer.scene(), context);
  const double rays = samples.rays(bare, false), sharedRays = samples.rays(bare, true),
               shadings = samples.shadings(), estimates = samples.estimates();
  const bool hasPaper = std::any_of(methods.begin(), methods.end(), isPaper);
  const double bounds =
      hasPaper ? boundsPerSecond(tracer, scene.lights(), receivers, settings) : kNone;
  BenchTable& table = report.table(emptyTable());
  for (size_t i = 0; i < methods.size(); ++i) {
    const SglcOutcome& o = *outcomes[i];
    const double seconds = o.seconds - o.trees;
    const double shared = o.sharedRays > 0 ? o.sharedRays / sharedRays : 0,
                 ray = (o.rays - o.sharedRays) / rays + shared, shading = o.shaded / shadings,
                 visits = isPaper(methods[i]) ? bounds : estimates, visit = o.visited / visits;
    table.rows.push_back({scene.stem(), methods[i].label, 1e-6 * rays, 1e-6 * sharedRays,
                          1e-6 * shadings, 1e-6 * visits, ray, shading, visit, seconds,
                          seconds / (ray + shading + visit)});
  }
  table.notes.push_back(scene.description());
}

}  // namespace lobelia::app
