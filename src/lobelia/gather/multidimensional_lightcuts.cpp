#include "lobelia/gather/multidimensional_lightcuts.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/chosen_gather.h"
#include "lobelia/gather/light_range.h"

namespace lobelia::gather {
namespace {

// Receivers pixel by pixel, and where the groups begin that are gathered together.
struct PixelGroups {
  Receivers receivers;
  std::vector<uint32_t> order;  // which of those given they are
  std::vector<size_t> begins;   // and the end
};

PixelGroups groupByPixel(const Receivers& given) {
  PixelGroups out;
  out.order.resize(given.points.size());
  std::iota(out.order.begin(), out.order.end(), 0u);
  std::stable_sort(out.order.begin(), out.order.end(), [&](uint32_t a, uint32_t b) {
    return given.points[a].pixel < given.points[b].pixel;
  });
  out.receivers.lobes = given.lobes;
  for (size_t i = 0; i < out.order.size(); ++i) {
    const ReceiverPoint& point = given.points[out.order[i]];
    const bool fresh = i == 0 || out.receivers.points.back().pixel != point.pixel ||
                       i - out.begins.back() == kMaxTilePoints;
    if (fresh) out.begins.push_back(i);
    out.receivers.points.push_back(point);
  }
  out.begins.push_back(out.order.size());
  return out;
}

}  // namespace

// One pixel after the other.
class MultidimensionalLightcuts::PixelGather {
 public:
  PixelGather(const MultidimensionalLightcuts& cuts, const Receivers& receivers, GatherTally* tally)
      : cuts_(cuts),
        receivers_(receivers),
        tally_(*tally),
        scale_(2 * cuts.tracer_.bounds().radius()),
        cut_(cuts.forest_,
             {cuts.settings_.threshold, cuts.settings_.cutSize, cuts.settings_.gather.clamp}) {}
  ~PixelGather() {
    tally_.evaluations += cut_.evaluations();
    tally_.pairs += values_.pairs;
    tally_.nonfinite += values_.nonfinite;
  }
  PixelGather(const PixelGather&) = delete;
  PixelGather& operator=(const PixelGather&) = delete;

  // Receivers [begin, end) of one pixel. Sets their light, weight included, and the rays that left
  // from them.
  void run(size_t begin, size_t end, std::span<Rgb> radiance, std::span<uint32_t> rays) {
    const int64_t start = nanosecondsNow(), traced = tally_.visibilityNs + tally_.shadeNs;
    rays_ = rays;
    tile_ = makeTile(receivers_, begin, end);
    if (tile_.strips.empty()) return cut_.clear();
    if (!cuts_.lights_.spherical.empty()) addSampling(receivers_, &tile_);
    const uint64_t seed = hashCombine(cuts_.settings_.seed, receivers_.points[begin].pixel);
    tree_.emplace(receivers_, begin, end, tile_, scale_, seed);
    const uint64_t bad = values_.nonfinite;
    cut_.run(*tree_, [&](std::span<ProductPair> fresh, std::span<const ProductPair> parents) {
      evaluate(fresh, parents);
    });
    sums_.assign(end - begin, {});
    for (const ProductPair& pair : cut_.pairs()) {
      const Rgb v = pair.value;
      sums_[pointOf(pair) - begin] += Vec3d{double{v.x}, double{v.y}, double{v.z}};
      tally_.clusteredLights += lightTree(pair).tree.nodes()[pair.lights].count;
      tally_.clusteredReceivers += tree_->tree().nodes()[pair.receivers].count;
    }
    for (size_t i = begin; i < end; ++i) {
      const Vec3d sum = sums_[i - begin];
      radiance[i] = {static_cast<float>(sum.x), static_cast<float>(sum.y),
                     static_cast<float>(sum.z)};
    }
    tally_.lights += cut_.pairs().size();
    tally_.clusters += cut_.pairs().size();
    if (values_.nonfinite != bad) tally_.noteBad(receivers_.points[begin].pixel);
    tally_.traverseNs += nanosecondsNow() - start - (tally_.visibilityNs + tally_.shadeNs - traced);
  }

  // The lights that the last cut has for a receiver.
  std::vector<ChosenLight> chosen(size_t point) const {
    std::vector<ChosenLight> lights;
    for (const ProductPair& pair : cut_.pairs()) {
      if (pointOf(pair) != point) continue;
      lights.push_back({lightTree(pair).lightClass,
                        cuts_.representatives_.light(pair.tree, pair.lights), Rgb(scaleOf(pair))});
    }
    std::sort(lights.begin(), lights.end());
    return lights;
  }

 private:
  const LightForest::Tree& lightTree(const ProductPair& pair) const {
    return cuts_.forest_.trees[pair.tree];
  }
  uint32_t leafOf(const ProductPair& pair) const {
    return cuts_.representatives_.leaf(pair.tree, pair.lights);
  }
  uint32_t placeOf(const ProductPair& pair) const { return tree_->place(pair.receiver); }
  size_t pointOf(const ProductPair& pair) const {
    const uint32_t place = placeOf(pair);
    return tile_.strips[place / kStrip].point[place % kStrip];
  }
  float scaleOf(const ProductPair& pair) const {
    return cuts_.representatives_.scale(pair.tree, pair.lights) *
           tree_->scale(pair.receivers, pair.receiver);
  }

  void evaluate(std::span<ProductPair> fresh, std::span<const ProductPair> parents) {
    for (ProductPair& pair : fresh)
      pair.receiver =
          tree_->representative(pair.receivers, uint64_t{pair.tree} << 32 | leafOf(pair));
    for (const LightClass lightClass : kLightClasses) {
      waiting_.clear();
      for (size_t i = 0; i < fresh.size(); ++i) {
        if (lightTree(fresh[i]).lightClass != lightClass) continue;
        const bool known = !parents.empty() && leafOf(parents[i / 2]) == leafOf(fresh[i]) &&
                           parents[i / 2].receiver == fresh[i].receiver;
        if (known) {
          fresh[i].representative = parents[i / 2].representative;
        } else {
          waiting_.push_back(&fresh[i]);
        }
      }
      for (size_t i = 0; i < waiting_.size(); i += kBlockLights)
        evaluateBlock(lightClass,
                      std::span(waiting_).subspan(i, std::min(kBlockLights, waiting_.size() - i)));
    }
    for (ProductPair& pair : fresh) pair.value = pair.representative * scaleOf(pair);
  }

  // What stands for the pairs, by the renderer's own kernels.
  void evaluateBlock(LightClass lightClass, std::span<ProductPair* const> pairs) {
    uint32_t indices[kBlockLights];
    for (size_t i = 0; i < pairs.size(); ++i)
      indices[i] = cuts_.representatives_.light(pairs[i]->tree, pairs[i]->lights);
    prepareChosen(cuts_.lights_, cuts_.tracer_.scene(), lightClass, {indices, pairs.size()},
                  &block_, cuts_.prepared_);
    allowPairs(tile_, block_, cuts_.lights_, cuts_.settings_.gather, &pairs_);
    const size_t strips = tile_.strips.size();
    for (size_t i = 0; i < pairs.size(); ++i) {
      const uint32_t place = placeOf(*pairs[i]);
      for (size_t s = 0; s < strips; ++s)
        pairs_.at(i, s) &= static_cast<uint16_t>(s == place / kStrip ? 1u << place % kStrip : 0u);
    }
    traced_.assign(pairs_.bits.size(), 0);
    pairs_.traced = &traced_;
    const int64_t start = nanosecondsNow();
    tally_.rays += keepVisible(tile_, block_, cuts_.tracer_, &pairs_);
    const int64_t seen = nanosecondsNow();
    values_.reset(pairs.size(), strips);
    shadePairs(tile_, block_, cuts_.settings_.gather.clamp, pairs_, &values_);
    for (size_t i = 0; i < pairs.size(); ++i) {
      const uint32_t place = placeOf(*pairs[i]);
      const size_t mask = i * strips + place / kStrip, at = mask * kStrip + place % kStrip;
      const size_t point = pointOf(*pairs[i]);
      pairs[i]->representative =
          receivers_.points[point].weight * Rgb(values_.x[at], values_.y[at], values_.z[at]);
      if (!rays_.empty()) rays_[point] += traced_[mask] >> place % kStrip & 1;
    }
    tally_.visibilityNs += seen - start;
    tally_.shadeNs += nanosecondsNow() - seen;
  }

  const MultidimensionalLightcuts& cuts_;
  const Receivers& receivers_;
  GatherTally& tally_;
  const float scale_;
  ProductCut cut_;
  std::span<uint32_t> rays_;
  Tile tile_;
  std::optional<GatherTree> tree_;
  LightBlock block_;
  PairMasks pairs_;
  PairValues values_;
  std::vector<uint16_t> traced_;
  std::vector<Vec3d> sums_;
  std::vector<ProductPair*> waiting_;
};

MultidimensionalLightcuts::MultidimensionalLightcuts(const Tracer& tracer,
                                                     const VirtualLights& lights,
                                                     const MultidimensionalSettings& settings,
                                                     Context& context)
    : tracer_(tracer),
      lights_(lights),
      settings_(settings),
      prepared_(prepareLights(lights, tracer.scene())) {
  const StageTimer timer(context, "trees");
  forest_ = plantLights(lights, settings.gather, 1, tracer.scene(), tracer.bounds(), prepared_);
  representatives_ = Representatives(forest_, settings.seed);
}

void MultidimensionalLightcuts::gather(const Receivers& receivers, uint32_t onlyPixel,
                                       std::span<Rgb> radiance, Context& context,
                                       GatherParts* parts) const {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument(
        "MultidimensionalLightcuts::gather: one radiance value per receiver point");
  if (parts != nullptr) parts->reset(points);
  if (points == 0) return;
  const PixelGroups groups = groupByPixel(receivers);
  std::optional<GatherParts> ordered;
  std::vector<Rgb> light(points), again;  // the latter by the parts' own sums, which are not wanted
  std::vector<uint32_t> rays, same;
  const bool takenApart = parts != nullptr && (parts->byType || parts->groupCount > 0);
  if (parts != nullptr) {
    ordered = *parts;
    again.resize(points);
    same.resize(points);
    std::iota(same.begin(), same.end(), 0u);
    if (parts->countRays) rays.resize(points);
  }
  constexpr size_t kGrain = 16;
  gatherInParallel(
      groups.begins.size() - 1, kGrain, context, [&](size_t begin, size_t end, GatherTally* tally) {
        GatherTally partsTally;
        PixelGather gather(*this, groups.receivers, tally);
        ChosenGather partGather(tracer_, groups.receivers, same, lights_, prepared_,
                                settings_.gather, ordered ? &*ordered : nullptr);
        for (size_t g = begin; g < end && !context.cancelled(); ++g) {
          const size_t first = groups.begins[g], last = groups.begins[g + 1];
          if (!holdsPixel(groups.receivers, first, last, onlyPixel)) continue;
          gather.run(first, last, light, rays);
          for (size_t i = first; i < last && takenApart; ++i)
            partGather.add(partGather.tileOf(i, i + 1), gather.chosen(i), again, &partsTally);
        }
        tally->rays += partsTally.rays;
      });
  for (size_t i = 0; i < points; ++i) radiance[groups.order[i]] += light[i];
  if (parts == nullptr) return;
  for (size_t i = 0; i < rays.size(); ++i) ordered->rays[i] += rays[i];
  parts->setOrdered(*ordered, groups.order, points);
}

}  // namespace lobelia::gather
