#include "lobelia/gather/stochastic_lightcuts.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/chosen_gather.h"
#include "lobelia/gather/cut_descent.h"

namespace lobelia::gather {
namespace {

// New random numbers for every receiver: those of other samples lie elsewhere.
uint64_t keyOf(const ReceiverPoint& point, uint64_t seed) {
  uint64_t key = hashCombine(hashCombine(seed, point.pixel), point.depth);
  for (const float v : {point.p.x, point.p.y, point.p.z, point.wo.x, point.wo.y})
    key = hashCombine(key, std::bit_cast<uint32_t>(v));
  return key;
}

}  // namespace

// The lights of one receiver after the other.
class StochasticLightcuts::PointCut {
 public:
  explicit PointCut(const StochasticLightcuts& cuts)
      : forest_(cuts.forest_),
        seed_(cuts.settings_.seed),
        refinement_(cuts.forest_, {cuts.settings_.threshold, cuts.settings_.cutSize,
                                   cuts.settings_.gather.clamp}),
        bounder_(cuts.forest_, 0),
        descent_(cuts.forest_) {}

  // By class.
  const std::vector<ChosenLight>& choose(const Receivers& receivers, size_t point,
                                         const PointStrip& strip) {
    const ReceiverNodes nodes = receiverNodes(receivers, point, strip);
    refinement_.run(nodes, [](std::span<CutNode> fresh, std::span<const CutNode>) {
      for (CutNode& node : fresh) node.value = Rgb(node.unshadowed);
    });
    chosen_.clear();
    const uint64_t key = keyOf(receivers.points[point], seed_);
    for (uint32_t t = 0; t < forest_.trees.size(); ++t) descend(nodes, t, hashCombine(key, t));
    return chosen_;
  }
  size_t cutSize() const { return refinement_.cut().size(); }
  uint64_t evaluations() const { return refinement_.evaluations() + bounder_.evaluations(); }

 private:
  void descend(const ReceiverNodes& nodes, uint32_t t, uint64_t key) {
    const LightForest::Tree& tree = forest_.trees[t];
    walkers_.clear();
    for (const CutNode& node : refinement_.cut()) {
      if (node.tree != t) continue;
      const double u = static_cast<double>(hashCombine(key, node.node) >> 11) * 0x1p-53;
      walkers_.push_back({node.node, u, 1});
    }
    descent_.run(nodes, t, &bounder_, walkers_);
    // In the order of the leaves: neighbours in a packet of rays.
    std::sort(walkers_.begin(), walkers_.end(),
              [](const auto& a, const auto& b) { return a.node < b.node; });
    for (const CutDescent::Walker& w : walkers_)
      chosen_.push_back({tree.lightClass, tree.lights[tree.tree.nodes()[w.node].first],
                         Rgb(static_cast<float>(1 / w.probability))});
  }

  const LightForest& forest_;
  const uint64_t seed_;
  CutRefinement refinement_;
  NodeBounder bounder_;  // of descents: without the clamp, which hides distances
  CutDescent descent_;
  std::vector<CutDescent::Walker> walkers_;
  std::vector<ChosenLight> chosen_;
};

StochasticLightcuts::StochasticLightcuts(const Tracer& tracer, const VirtualLights& lights,
                                         const StochasticSettings& settings, Context& context)
    : tracer_(tracer),
      lights_(lights),
      settings_(settings),
      prepared_(prepareLights(lights, tracer.scene())) {
  const StageTimer timer(context, "trees");
  forest_ = plantLights(lights, settings.gather, 1, tracer.scene(), tracer.bounds(), prepared_);
  for (const LightForest::Tree& tree : forest_.trees) lightCount_ += tree.lights.size();
}

void StochasticLightcuts::gather(const Receivers& receivers, uint32_t onlyPixel,
                                 std::span<Rgb> radiance, Context& context,
                                 GatherParts* parts) const {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument("StochasticLightcuts::gather: one value per receiver point");
  std::vector<uint32_t> order(points);
  std::iota(order.begin(), order.end(), 0u);
  if (parts != nullptr) parts->reset(points);
  constexpr size_t kGrain = 32;
  gatherInParallel(points, kGrain, context, [&](size_t begin, size_t end, GatherTally* tally) {
    PointCut cut(*this);
    ChosenGather gather(tracer_, receivers, order, lights_, prepared_, settings_.gather, parts);
    for (size_t i = begin; i < end && !context.cancelled(); ++i) {
      if (!holdsPixel(receivers, i, i + 1, onlyPixel)) continue;
      const int64_t start = nanosecondsNow();
      const Tile tile = gather.tileOf(i, i + 1);
      if (tile.strips.empty()) continue;
      const std::vector<ChosenLight>& chosen = cut.choose(receivers, i, tile.strips[0]);
      tally->lights += cut.cutSize();
      tally->clusteredLights += lightCount_;
      ++tally->clusters, ++tally->clusteredReceivers;
      tally->traverseNs += nanosecondsNow() - start;
      gather.add(tile, chosen, radiance, tally);
    }
    tally->evaluations = cut.evaluations();
  });
}

}  // namespace lobelia::gather
