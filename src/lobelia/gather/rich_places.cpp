#include "lobelia/gather/rich_places.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <tuple>

#include "lobelia/base/morton.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/light_forest.h"
#include "lobelia/gather/mrcs_sampling.h"

namespace lobelia::gather {
namespace {

// A difference of normals of 1 counts as much as this share of the scene's size.
constexpr float kNormalShare = 0.25f;
constexpr float kGroupsApart = 10;
constexpr double kPowerShare = 0.5;  // of the weight of a light, the rest by importance

bool isRich(LightClass lightClass) {
  return lightClass == LightClass::diffuse || lightClass == LightClass::glossy;
}

// Place, normal and light group as the nearest place is told by.
using Coordinates = std::array<float, 7>;
struct Sites {
  std::vector<Coordinates> coordinates;
  size_t kdtree_get_point_count() const { return coordinates.size(); }
  float kdtree_get_pt(size_t i, size_t axis) const { return coordinates[i][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using SiteTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Sites>, Sites,
                                        std::tuple_size_v<Coordinates>, uint32_t>;

// Light that the sample gets of every light, luminances; 0 of lights that stay as they are.
std::vector<float> importanceOf(const Tracer& tracer, const Receivers& sample,
                                const VirtualLights& lights, const LightNumbers& numbers,
                                const GatherSettings& settings, Context& context) {
  const StageTimer timer(context, "rows");
  std::vector<Tile> tiles;
  for (size_t begin = 0; begin < sample.points.size(); begin += kMaxTilePoints)
    tiles.push_back(
        makeTile(sample, begin, std::min(sample.points.size(), begin + kMaxTilePoints)));
  std::vector<float> importance(numbers.count(), 0.f);
  std::atomic<uint64_t> rays{0}, shaded{0}, nonfinite{0};
  parallelFor(numbers.blockCount(), 1, [&](size_t b) {
    const LightNumbers::Block own = numbers.block(b);
    if (!isRich(own.lightClass) || context.cancelled()) return;
    LightBlock block;
    PairMasks pairs;
    PairValues values;
    prepare(lights, tracer.scene(), own.lightClass, own.first, own.count, &block);
    for (const Tile& tile : tiles) {
      allowPairs(tile, block, lights, settings, &pairs);
      rays += keepVisible(tile, block, tracer, &pairs);
      values.reset(own.count, tile.strips.size());
      shadePairs(tile, block, settings.clamp, pairs, &values);
      for (size_t i = 0; i < own.count * tile.strips.size() * kStrip; ++i) {
        const PointStrip& strip = tile.strips[i / kStrip % tile.strips.size()];
        const ReceiverPoint& point = sample.points[strip.point[i % kStrip]];
        if ((strip.active >> i % kStrip & 1) == 0) continue;
        importance[own.number + i / (kStrip * tile.strips.size())] +=
            luminance(point.weight * Rgb(values.x[i], values.y[i], values.z[i]));
      }
    }
    shaded += values.pairs, nonfinite += values.nonfinite;
  });
  context.statistics.addCount("shadow_rays", rays);
  context.statistics.addCount("node_pairs_shaded", shaded);
  context.statistics.addCount("nonfinite", nonfinite);
  return importance;
}

// Probabilities of being drawn in proportion to weights, at most 1, that add up to count.
std::vector<double> drawProbabilities(const std::vector<double>& weights, double count) {
  std::vector<double> probabilities(weights.size(), 0.0);
  std::vector<bool> sure(weights.size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    double sum = 0, left = count;
    for (size_t i = 0; i < weights.size(); ++i) sure[i] ? left -= 1 : sum += weights[i];
    const double scale = sum > 0 ? left / sum : 0;
    for (size_t i = 0; i < weights.size(); ++i) {
      if (sure[i]) continue;
      probabilities[i] = weights[i] * scale;
      if (probabilities[i] < 1) continue;
      probabilities[i] = 1;
      sure[i] = changed = true;
    }
  }
  return probabilities;
}

class Chooser {
 public:
  Chooser(const VirtualLights& lights, const LightNumbers& numbers, const Bounds3f& bounds)
      : lights_(lights), numbers_(numbers), bounds_(bounds) {
    for (size_t i = 0; i < numbers.count(); ++i)
      if (isRich(numbers.at(i).lightClass)) rich_.push_back(static_cast<uint32_t>(i));
    for (const uint32_t i : rich_) {
      const ChosenLight light = numbers.at(i);
      sites_.push_back(siteOf(lights, light));
      groups_.push_back(groupOf(lights, light.lightClass, light.index));
    }
  }

  RichPlaces choose(const std::vector<float>& importance, size_t count, uint64_t seed) const {
    RichPlaces places;
    places.placeOf.assign(numbers_.count(), RichPlaces::kNone);
    const std::vector<double> probabilities = drawProbabilities(
        weightsOf(importance), static_cast<double>(std::min(count, rich_.size())));
    std::vector<size_t> at;  // of the places, in rich_
    double next = uniformNumber(seed, 0);
    // What rounding of sums may leave out at the end is sure to be drawn where all are.
    constexpr double kSure = 1 - 1e-9;
    for (const uint32_t i : alongCurve()) {
      next -= probabilities[i];
      if (next >= 0 && probabilities[i] < kSure) continue;
      next = next < 0 ? next + 1 : next;
      at.push_back(i);
    }
    addMissingGroups(probabilities, &at);
    for (const size_t i : at) {
      places.placeOf[rich_[i]] = static_cast<uint32_t>(places.light.size());
      places.light.push_back(rich_[i]);
    }
    join(at, &places);
    return places;
  }

 private:
  std::vector<double> weightsOf(const std::vector<float>& importance) const {
    std::vector<double> weights(rich_.size()), powers(rich_.size());
    double total = 0, power = 0;
    for (size_t i = 0; i < rich_.size(); ++i) {
      const ChosenLight light = numbers_.at(rich_[i]);
      weights[i] = double{importance[rich_[i]]};
      powers[i] = double{luminance(lightPower(lights_, light.lightClass, light.index))};
      total += weights[i], power += powers[i];
    }
    const double share = total > 0 ? kPowerShare : 1;
    for (size_t i = 0; i < weights.size(); ++i) {
      weights[i] *= total > 0 ? (1 - share) / total : 0.0;
      weights[i] += power > 0 ? share * powers[i] / power : 1.0;
    }
    return weights;
  }

  // Group by group, by what normals face, then by place: what is drawn evenly along it is spread
  // evenly over surfaces.
  std::vector<uint32_t> alongCurve() const {
    struct Key {
      uint64_t side;
      uint32_t code, light;
      bool operator<(const Key& o) const {
        return std::tie(side, code, light) < std::tie(o.side, o.code, o.light);
      }
    };
    std::vector<Key> keys(rich_.size());
    const float scale = 1 / std::max(maxComponent(bounds_.extent()), 1e-30f);
    parallelFor(keys.size(), 4096, [&](size_t i) {
      const Vec3f n = sites_[i].n, a{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
      const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
      const uint64_t side = 2 * static_cast<uint64_t>(axis) + (n[axis] < 0 ? 1 : 0);
      keys[i] = {uint64_t{groups_[i]} * 6 + side, morton((sites_[i].p - bounds_.lo) * scale),
                 static_cast<uint32_t>(i)};
    });
    std::sort(keys.begin(), keys.end());
    std::vector<uint32_t> order;
    order.reserve(keys.size());
    for (const Key& key : keys) order.push_back(key.light);
    return order;
  }

  // The likeliest light of a group without a place is one.
  void addMissingGroups(const std::vector<double>& probabilities, std::vector<size_t>* at) const {
    constexpr size_t kNone = std::numeric_limits<size_t>::max(), kHas = kNone - 1;
    std::vector<size_t> best(1 + *std::max_element(groups_.begin(), groups_.end()), kNone);
    for (const size_t i : *at) best[groups_[i]] = kHas;
    for (size_t i = 0; i < rich_.size(); ++i) {
      size_t& own = best[groups_[i]];
      if (own != kHas && (own == kNone || probabilities[i] > probabilities[own])) own = i;
    }
    for (const size_t i : best)
      if (i < kHas) at->push_back(i);
  }

  Coordinates coordinatesOf(size_t i) const {
    const Vec3f p = (sites_[i].p - bounds_.lo) / std::max(2 * bounds_.radius(), 1e-30f);
    const Vec3f n = sites_[i].n * kNormalShare;
    return {p.x, p.y, p.z, n.x, n.y, n.z, kGroupsApart * static_cast<float>(groups_[i])};
  }

  void join(const std::vector<size_t>& at, RichPlaces* places) const {
    Sites sites;
    for (const size_t i : at) sites.coordinates.push_back(coordinatesOf(i));
    const SiteTree tree(static_cast<int>(std::tuple_size_v<Coordinates>), sites);
    parallelFor(rich_.size(), 256, [&](size_t i) {
      uint32_t& place = places->placeOf[rich_[i]];
      if (place != RichPlaces::kNone) return;
      const Coordinates own = coordinatesOf(i);
      float distance = 0;
      tree.knnSearch(own.data(), 1, &place, &distance);
    });
  }

  const VirtualLights& lights_;
  const LightNumbers& numbers_;
  const Bounds3f bounds_;
  std::vector<uint32_t> rich_;  // numbers of the lights that are joined; parallel to it:
  std::vector<LightSite> sites_;
  std::vector<uint16_t> groups_;
};

}  // namespace

LightSite siteOf(const VirtualLights& lights, const ChosenLight& light) {
  if (light.lightClass == LightClass::glossy)
    return {lights.glossy[light.index].p, lights.glossy[light.index].n};
  const DiffuseLight& diffuse = lights.diffuse[light.index];
  return {diffuse.p, decodeOctahedral(diffuse.normal)};
}

RichPlaces chooseRichPlaces(const Tracer& tracer, const Receivers& sample,
                            const VirtualLights& lights, const LightNumbers& numbers,
                            const RichPlaceSettings& settings, Context& context) {
  const Bounds3f bounds = tracer.bounds();
  GatherSettings limited = settings.gather;
  const float size = std::max(2 * bounds.radius(), 1e-30f);
  const float spread = static_cast<float>(settings.count) / (kPi * size * size);
  limited.clamp = limited.clamp > 0 ? std::min(limited.clamp, spread) : spread;
  const std::vector<float> importance =
      importanceOf(tracer, sample, lights, numbers, limited, context);
  const StageTimer timer(context, "cluster");
  const Chooser chooser(lights, numbers, bounds);
  return chooser.choose(importance, settings.count, settings.seed);
}

}  // namespace lobelia::gather
