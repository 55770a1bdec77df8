#include "lobelia/gather/lightcuts.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/chosen_gather.h"
#include "lobelia/gather/light_range.h"

namespace lobelia::gather {

// One receiver after the other.
class Lightcuts::PointGather {
 public:
  PointGather(const Lightcuts& cuts, const Receivers& receivers, GatherTally* tally)
      : cuts_(cuts),
        receivers_(receivers),
        tally_(*tally),
        refinement_(cuts.forest_, {cuts.settings_.threshold, cuts.settings_.cutSize,
                                   cuts.settings_.gather.clamp}) {}
  ~PointGather() { tally_.evaluations += refinement_.evaluations(); }
  PointGather(const PointGather&) = delete;
  PointGather& operator=(const PointGather&) = delete;

  // The light of the receiver's cut, without weight.
  Rgb run(size_t point) {
    const int64_t start = nanosecondsNow(), traced = tally_.visibilityNs + tally_.shadeNs;
    tile_ = makeTile(receivers_, point, point + 1);
    if (tile_.strips.empty()) return {};
    if (!cuts_.lights_.spherical.empty()) addSampling(receivers_, &tile_);
    const uint64_t bad = values_.nonfinite;
    refinement_.run(receiverNodes(receivers_, point, tile_.strips[0]),
                    [&](std::span<CutNode> fresh, std::span<const CutNode> parents) {
                      evaluate(fresh, parents);
                    });
    Vec3d sum;
    for (const CutNode& node : refinement_.cut())
      sum += Vec3d{double{node.value.x}, double{node.value.y}, double{node.value.z}};
    tally_.lights += refinement_.cut().size();
    tally_.clusteredLights += cuts_.representatives_.lightCount();
    ++tally_.clusters, ++tally_.clusteredReceivers;
    if (values_.nonfinite != bad) tally_.noteBad(receivers_.points[point].pixel);
    tally_.traverseNs += nanosecondsNow() - start - (tally_.visibilityNs + tally_.shadeNs - traced);
    return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
  }

  const Tile& tile() const { return tile_; }
  // The lights of the last cut.
  std::vector<ChosenLight> chosen() const {
    std::vector<ChosenLight> lights;
    for (const CutNode& node : refinement_.cut()) {
      const LightForest::Tree& tree = cuts_.forest_.trees[node.tree];
      lights.push_back({tree.lightClass, lightOf(node), Rgb(scaleOf(node))});
    }
    std::sort(lights.begin(), lights.end());
    return lights;
  }
  // The same, with their nodes.
  void record(size_t point, RecordedCut* out) const {
    out->receivers = {static_cast<uint32_t>(point)};
    for (const CutNode& node : refinement_.cut()) {
      const trees::BoundTree& tree = cuts_.forest_.trees[node.tree].tree;
      const uint32_t place = tree.nodes()[leafOf(node)].first;
      out->nodes.push_back({node.tree, node.node, static_cast<int32_t>(place), scaleOf(node),
                            luminance(node.value), node.upper, 0});
    }
  }
  void countPairs() const {
    tally_.pairs += values_.pairs;
    tally_.nonfinite += values_.nonfinite;
  }

 private:
  uint32_t leafOf(const CutNode& node) const {
    return cuts_.representatives_.leaf(node.tree, node.node);
  }
  uint32_t lightOf(const CutNode& node) const {
    return cuts_.representatives_.light(node.tree, node.node);
  }
  float scaleOf(const CutNode& node) const {
    return cuts_.representatives_.scale(node.tree, node.node);
  }

  void evaluate(std::span<CutNode> fresh, std::span<const CutNode> parents) {
    for (const LightClass lightClass : kLightClasses) {
      waiting_.clear();
      for (size_t i = 0; i < fresh.size(); ++i) {
        if (cuts_.forest_.trees[fresh[i].tree].lightClass != lightClass) continue;
        if (!parents.empty() && leafOf(parents[i / 2]) == leafOf(fresh[i])) {
          fresh[i].representative = parents[i / 2].representative;
        } else {
          waiting_.push_back(&fresh[i]);
        }
      }
      for (size_t i = 0; i < waiting_.size(); i += kBlockLights)
        evaluateBlock(lightClass,
                      std::span(waiting_).subspan(i, std::min(kBlockLights, waiting_.size() - i)));
    }
    for (CutNode& node : fresh) node.value = node.representative * scaleOf(node);
  }

  // What stands for the nodes, by the renderer's own kernels on the one receiver.
  void evaluateBlock(LightClass lightClass, std::span<CutNode* const> nodes) {
    uint32_t indices[kBlockLights];
    for (size_t i = 0; i < nodes.size(); ++i) indices[i] = lightOf(*nodes[i]);
    prepareChosen(cuts_.lights_, cuts_.tracer_.scene(), lightClass, {indices, nodes.size()},
                  &block_, cuts_.prepared_);
    allowPairs(tile_, block_, cuts_.lights_, cuts_.settings_.gather, &pairs_);
    const int64_t start = nanosecondsNow();
    tally_.rays += keepVisible(tile_, block_, cuts_.tracer_, &pairs_);
    const int64_t traced = nanosecondsNow();
    values_.reset(nodes.size(), 1);
    shadePairs(tile_, block_, cuts_.settings_.gather.clamp, pairs_, &values_);
    for (size_t i = 0; i < nodes.size(); ++i)
      nodes[i]->representative = {values_.x[i * kStrip], values_.y[i * kStrip],
                                  values_.z[i * kStrip]};
    tally_.visibilityNs += traced - start;
    tally_.shadeNs += nanosecondsNow() - traced;
  }

  const Lightcuts& cuts_;
  const Receivers& receivers_;
  GatherTally& tally_;
  CutRefinement refinement_;
  Tile tile_;
  LightBlock block_;
  PairMasks pairs_;
  PairValues values_;
  std::vector<CutNode*> waiting_;
};

Lightcuts::Lightcuts(const Tracer& tracer, const VirtualLights& lights,
                     const LightcutsSettings& settings, Context& context)
    : tracer_(tracer),
      lights_(lights),
      settings_(settings),
      prepared_(prepareLights(lights, tracer.scene())) {
  const StageTimer timer(context, "trees");
  forest_ = plantLights(lights, settings.gather, 1, tracer.scene(), tracer.bounds(), prepared_);
  representatives_ = Representatives(forest_, settings_.seed);
}

std::vector<ExportedTree> Lightcuts::exportTrees() const {
  std::vector<ExportedTree> trees;
  for (const LightForest::Tree& tree : forest_.trees) trees.push_back(exportTree(tree, lights_));
  return trees;
}

void Lightcuts::gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
                       Context& context, GatherParts* parts) const {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument("Lightcuts::gather: one radiance value per receiver point");
  std::vector<uint32_t> order;
  std::vector<Rgb> again;  // by the parts' own sums, which are not wanted
  if (parts != nullptr) {
    parts->reset(points);
    order.resize(points);
    std::iota(order.begin(), order.end(), 0u);
    again.resize(points);
    parts->cuts.assign(parts->recordCuts ? points : 0, {});
  }
  constexpr size_t kGrain = 32;
  gatherInParallel(points, kGrain, context, [&](size_t begin, size_t end, GatherTally* tally) {
    GatherTally partsTally;
    PointGather gather(*this, receivers, tally);
    ChosenGather partGather(tracer_, receivers, order, lights_, prepared_, settings_.gather, parts);
    for (size_t i = begin; i < end && !context.cancelled(); ++i) {
      if (!holdsPixel(receivers, i, i + 1, onlyPixel)) continue;
      const uint64_t before = tally->rays;
      radiance[i] += receivers.points[i].weight * gather.run(i);
      if (parts == nullptr) continue;
      if (parts->recordCuts) gather.record(i, &parts->cuts[i]);
      if (parts->byType || parts->groupCount > 0)
        partGather.add(gather.tile(), gather.chosen(), again, &partsTally);
      tally->rays += partsTally.rays;
      partsTally.rays = 0;
      if (parts->countRays) parts->rays[i] = static_cast<uint32_t>(tally->rays - before);
    }
    gather.countPairs();
  });
}

}  // namespace lobelia::gather
