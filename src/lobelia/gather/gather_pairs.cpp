#include "lobelia/gather/gather_pairs.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/pixel_range.h"

namespace lobelia::gather {
namespace {

constexpr int kEstimateLevel = 6;
constexpr float kFloorShare = 0.05f;

struct Pairing {
  LightClass classes[2];
  bool glossy;  // receivers
  bool has(LightClass c) const { return c == classes[0] || c == classes[1]; }
};
constexpr Pairing kPairings[] = {
    {{LightClass::omni, LightClass::directional}, false},
    {{LightClass::omni, LightClass::directional}, true},
    {{LightClass::diffuse, LightClass::diffuse}, false},
    {{LightClass::diffuse, LightClass::diffuse}, true},
    {{LightClass::glossy, LightClass::glossy}, false},
    {{LightClass::glossy, LightClass::glossy}, true},
    {{LightClass::spherical, LightClass::spherical}, false},
    {{LightClass::spherical, LightClass::spherical}, true},
    {{LightClass::gaussian, LightClass::gaussian}, false},
    {{LightClass::gaussian, LightClass::gaussian}, true},
};

// Largest nodes below `node` that fit a strip.
void addStrips(const trees::BoundTree& tree, uint32_t node, std::vector<uint32_t>* out) {
  if (tree.nodes()[node].count <= kStrip) return out->push_back(node);
  addStrips(tree, tree.left(node), out);
  addStrips(tree, tree.right(node), out);
}

}  // namespace

// One call of gather().
class LightPairs::Run {
 public:
  Run(const LightPairs& pairs, const Receivers& receivers, GatherParts* parts, Context& context)
      : pairs_(pairs),
        settings_(pairs.settings_),
        receivers_(receivers),
        range_(pixelRangeOf(receivers)),
        parts_(parts),
        context_(context),
        scene_{pairs.tracer_,   pairs.lights_,          pairs.prepared_,
               settings_.share, settings_.gather.clamp, settings_.seed},
        estimateScene_{pairs.tracer_,     pairs.lights_,          pairs.prepared_,
                       Share::visibility, settings_.gather.clamp, settings_.seed} {
    pixels_.resize(range_.size);
    for (const ReceiverPoint& point : receivers.points) pixels_[range_.at(point.pixel)].used = true;
    radiance_.resize(receivers.points.size());
    if (parts != nullptr) parts->reset(receivers.points.size());
    const StageTimer timer(context, "trees");
    forest_ = plantReceivers(receivers, 2 * pairs.tracer_.bounds().radius(),
                             settings_.gather.maxDepth >= 0, settings_.gather.clamp > 0);
  }

  // False when cancelled.
  bool run() {
    for (const Pairing& pairing : kPairings) {
      std::vector<Job> jobs = jobsOf(pairing);
      if (settings_.threshold > 0) estimate(&jobs);
      const float floor = kFloorShare * meanLight();
      const double before = static_cast<double>(&pairing - kPairings);
      std::atomic<size_t> done{0};
      forJobs(&jobs, [&](Job* job) {
        gather(job, floor);
        const double share = static_cast<double>(++done) / static_cast<double>(jobs.size());
        context_.progress("gather", (before + share) / static_cast<double>(std::size(kPairings)));
      });
      if (context_.cancelled()) return false;
      for (const Job& job : jobs) add(job);
      if (parts_ != nullptr && parts_->recordCuts)
        for (Job& job : jobs) record(&job);
      for (Pixel& pixel : pixels_) pixel.estimate = 0;
    }
    return true;
  }

  void write(std::span<Rgb> radiance) const {
    for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += radiance_[i];
    const double toSeconds = 1e-9 / threadCount();
    Statistics& statistics = context_.statistics;
    statistics.addCount("shadow_rays", tally_.rays);
    statistics.addCount("node_pairs_visited", tally_.bounded);
    statistics.addCount("node_pairs_shaded", tally_.shaded);
    statistics.addCount("nonfinite", tally_.nonfinite);
    statistics.addCount("receiver_clusters", tally_.nodes);
    statistics.addCount("clustered_receivers", tally_.nodeReceivers);
    statistics.addCount("cut_lights", tally_.nodeReceivers);
    statistics.addCount("clustered_lights", tally_.covered);
    statistics.addSeconds("traverse", static_cast<double>(tally_.traverseNs) * toSeconds);
    statistics.addSeconds("visibility", static_cast<double>(tally_.visibilityNs) * toSeconds);
    statistics.addSeconds("shade", static_cast<double>(tally_.shadeNs) * toSeconds);
  }

 private:
  struct Pixel {
    float light = 0, estimate = 0;  // of the pairings before, of this one
    bool used = false;
  };
  struct Tally {
    uint64_t rays = 0, bounded = 0, shaded = 0, nonfinite = 0, nodes = 0, nodeReceivers = 0,
             covered = 0;
    int64_t traverseNs = 0, visibilityNs = 0, shadeNs = 0;
  };
  // The receivers of a tile with the lights of a tree.
  struct Job {
    const ReceiverForest::Tree* receivers;
    const LightForest::Tree* lights;
    uint32_t node;
    std::vector<Rgb> radiance;  // of the tile's receivers
    std::vector<uint32_t> rays;
    Tally tally;
    std::optional<uint32_t> firstBad;
    std::vector<TreePair> pairs;  // where cuts are recorded

    const trees::BoundNode& tile() const { return receivers->tree.nodes()[node]; }
    void take(const PairShading& shading) {
      for (uint32_t i = 0; i < radiance.size(); ++i) radiance[i] = shading.radiance(i);
      for (uint32_t i = 0; i < rays.size(); ++i) rays[i] += shading.receiverRays[i];
      tally.bounded += shading.bounded;
      tally.rays += shading.rays, tally.shaded += shading.shaded;
      tally.nonfinite += shading.nonfinite;
      tally.visibilityNs += shading.visibilityNs, tally.shadeNs += shading.shadeNs;
      firstBad = shading.firstBad;
    }
  };

  std::vector<Job> jobsOf(const Pairing& pairing) const {
    std::vector<Job> jobs;
    for (const ReceiverForest::Tree& receivers : forest_.trees) {
      if (receivers.glossy != pairing.glossy) continue;
      const LightForest& lights = pairs_.forestFor(receivers.depth);
      for (const LightForest::Tree& tree : lights.trees) {
        if (!pairing.has(tree.lightClass)) continue;
        for (const uint32_t node : receivers.tiles) {
          jobs.push_back({&receivers, &tree, node, {}, {}, {}, {}, {}});
          jobs.back().radiance.resize(jobs.back().tile().count);
          jobs.back().rays.assign(jobs.back().tile().count, 0);
        }
      }
    }
    return jobs;
  }

  template <class F>
  void forJobs(std::vector<Job>* jobs, const F& f) const {
    parallelFor(jobs->size(), 1, [&](size_t i) {
      if (!context_.cancelled()) f(&(*jobs)[i]);
    });
  }

  Pixel& pixelOf(const Job& job, uint32_t i) {
    return pixels_[range_.at(job.receivers->receivers.points[job.tile().first + i].pixel)];
  }

  // Light of the first levels of the light trees, in strips of receivers.
  void estimate(std::vector<Job>* jobs) {
    forJobs(jobs, [&](Job* job) {
      std::vector<uint32_t> strips;
      addStrips(job->receivers->tree, job->node, &strips);
      std::vector<TreePair> pairs;
      for (const uint32_t q : nodesOfLevel(job->lights->tree, kEstimateLevel))
        for (const uint32_t p : strips) pairs.push_back({p, q});
      PairShading shading(estimateScene_, *job->receivers, job->node);
      shading.add(*job->lights, &pairs);
      job->take(shading);
    });
    for (const Job& job : *jobs)
      for (uint32_t i = 0; i < job.radiance.size(); ++i)
        pixelOf(job, i).estimate += luminance(job.radiance[i]);
  }

  float meanLight() const {
    double sum = 0, count = 0;
    for (const Pixel& pixel : pixels_)
      if (pixel.used) sum += double{pixel.light} + double{pixel.estimate}, ++count;
    return count > 0 ? static_cast<float>(sum / count) : 0.f;
  }

  void gather(Job* job, float floor) {
    const int64_t start = nanosecondsNow();
    PairShading shading(scene_, *job->receivers, job->node);
    PairTraversal traversal(job->receivers->tree, job->receivers->glossy, *job->lights,
                            traversalOf(job->lights->lightClass),
                            {settings_.gather.clamp, job->receivers->clamped});
    const std::vector<float> thresholds = thresholdsOf(*job, floor);
    job->tally.bounded += traversal.run(job->node, thresholds, [&](std::vector<TreePair>* pairs) {
      if (context_.cancelled()) return false;
      for (const TreePair& pair : *pairs) {
        const uint64_t receivers = job->receivers->tree.nodes()[pair.receivers].count;
        ++job->tally.nodes;
        job->tally.nodeReceivers += receivers;
        job->tally.covered += receivers * job->lights->tree.nodes()[pair.lights].count;
      }
      if (parts_ != nullptr && parts_->recordCuts)
        job->pairs.insert(job->pairs.end(), pairs->begin(), pairs->end());
      shading.add(*job->lights, pairs, thresholds);
      return true;
    });
    job->tally.traverseNs += nanosecondsNow() - start - shading.visibilityNs - shading.shadeNs;
    job->take(shading);
  }

  TraversalSettings traversalOf(LightClass lightClass) const {
    TraversalSettings traversal = settings_.traversal;
    if (lightClass == LightClass::omni || lightClass == LightClass::directional)
      traversal.error = TraversalSettings::Error::conservative;
    return traversal;
  }

  // Of the tile's nodes, in preorder: the smallest of their receivers.
  std::vector<float> thresholdsOf(const Job& job, float floor) {
    const trees::BoundTree& tree = job.receivers->tree;
    const trees::BoundNode& tile = job.tile();
    std::vector<float> thresholds(2 * size_t{tile.count} - 1);
    for (uint32_t i = static_cast<uint32_t>(thresholds.size()); i-- > 0;) {
      const trees::BoundNode& node = tree.nodes()[job.node + i];
      if (node.leaf()) {
        const Pixel& pixel = pixelOf(job, node.first - tile.first);
        thresholds[i] = static_cast<float>(settings_.threshold) *
                        std::max({pixel.light, pixel.estimate, floor});
      } else {
        thresholds[i] = std::min(thresholds[tree.left(job.node + i) - job.node],
                                 thresholds[tree.right(job.node + i) - job.node]);
      }
    }
    return thresholds;
  }

  void add(const Job& job) {
    const size_t points = receivers_.points.size();
    const size_t type =
        2 * static_cast<size_t>(job.lights->lightClass) + (job.receivers->glossy ? 1 : 0);
    for (uint32_t i = 0; i < job.radiance.size(); ++i) {
      const uint32_t point = job.receivers->points[job.tile().first + i];
      radiance_[point] += job.radiance[i];
      pixelOf(job, i).light += luminance(job.radiance[i]);
      if (parts_ == nullptr) continue;
      if (parts_->byType) parts_->types[type * points + point] += job.radiance[i];
      if (job.lights->group < parts_->groupCount)
        parts_->groups[job.lights->group * points + point] += job.radiance[i];
      if (parts_->countRays) parts_->rays[point] += job.rays[i];
    }
    if (job.firstBad) noteNonFinitePixel(*job.firstBad, context_);
    const Tally& t = job.tally;
    tally_.rays += t.rays, tally_.bounded += t.bounded, tally_.shaded += t.shaded;
    tally_.nonfinite += t.nonfinite, tally_.nodes += t.nodes, tally_.covered += t.covered;
    tally_.nodeReceivers += t.nodeReceivers, tally_.traverseNs += t.traverseNs;
    tally_.visibilityNs += t.visibilityNs, tally_.shadeNs += t.shadeNs;
  }

  // A cut for each node of receivers that pairs have.
  void record(Job* job) {
    std::sort(job->pairs.begin(), job->pairs.end(), [](const TreePair& a, const TreePair& b) {
      return a.receivers != b.receivers ? a.receivers < b.receivers : a.lights < b.lights;
    });
    const uint32_t number = pairs_.numberOf(job->lights);
    for (size_t i = 0; i < job->pairs.size(); ++i) {
      const TreePair& pair = job->pairs[i];
      if (i == 0 || pair.receivers != job->pairs[i - 1].receivers) {
        RecordedCut& cut = parts_->cuts.emplace_back();
        cut.lobes =
            job->receivers->glossy ? RecordedCut::Lobes::glossy : RecordedCut::Lobes::diffuse;
        const trees::BoundNode& node = job->receivers->tree.nodes()[pair.receivers];
        const auto points = std::span(job->receivers->points).subspan(node.first, node.count);
        cut.receivers.assign(points.begin(), points.end());
      }
      const trees::BoundNode& node = job->lights->tree.nodes()[pair.lights];
      const int32_t light = node.leaf() ? static_cast<int32_t>(node.first) : -1;
      parts_->cuts.back().nodes.push_back({number, pair.lights, light, 1, 0, -1, 0});
    }
    job->pairs.clear();
  }

  const LightPairs& pairs_;
  const PairGatherSettings& settings_;
  const Receivers& receivers_;
  const PixelRange range_;
  GatherParts* parts_;
  Context& context_;
  const PairScene scene_, estimateScene_;  // estimates are each receiver's own
  ReceiverForest forest_;
  std::vector<Pixel> pixels_;
  std::vector<Rgb> radiance_;
  Tally tally_;
};

LightPairs::LightPairs(const Tracer& tracer, const VirtualLights& lights,
                       const PairGatherSettings& settings, Context& context)
    : tracer_(tracer), lights_(lights), settings_(settings) {
  const StageTimer timer(context, "trees");
  prepared_ = prepareLights(lights, tracer.scene());
  forestFor(1);
}

const LightForest& LightPairs::forestFor(int receiverDepth) const {
  std::vector<size_t> ends;
  for (const LightClass lightClass : kLightClasses)
    ends.push_back(rangeForDepth(lights_, lightClass, settings_.gather, receiverDepth).end);
  const std::lock_guard lock(mutex_);
  const auto found = forests_.find(ends);
  if (found != forests_.end()) return found->second;
  LightForest& forest = forests_[ends];
  forest = plantLights(lights_, settings_.gather, receiverDepth, tracer_.scene(), tracer_.bounds(),
                       prepared_);
  planted_.push_back(&forest);
  return forest;
}

uint32_t LightPairs::numberOf(const LightForest::Tree* tree) const {
  const std::lock_guard lock(mutex_);
  size_t before = 0;
  for (const LightForest* forest : planted_) {
    const LightForest::Tree* first = forest->trees.data();
    if (std::less_equal<>()(first, tree) && std::less<>()(tree, first + forest->trees.size()))
      return static_cast<uint32_t>(before + static_cast<size_t>(tree - first));
    before += forest->trees.size();
  }
  throw std::logic_error("LightPairs::numberOf: a tree of another strategy");
}

std::vector<ExportedTree> LightPairs::exportTrees() const {
  const std::lock_guard lock(mutex_);
  std::vector<ExportedTree> trees;
  for (const LightForest* forest : planted_)
    for (const LightForest::Tree& tree : forest->trees) trees.push_back(exportTree(tree, lights_));
  return trees;
}

void LightPairs::gather(const Receivers& receivers, uint32_t, std::span<Rgb> radiance,
                        Context& context, GatherParts* parts) const {
  if (radiance.size() != receivers.points.size())
    throw std::invalid_argument("LightPairs::gather: one radiance value per receiver point");
  if (receivers.points.empty()) {
    if (parts != nullptr) parts->reset(0);
    return;
  }
  Run run(*this, receivers, parts, context);
  if (run.run()) run.write(radiance);
}

}  // namespace lobelia::gather
