#include "lobelia/gather/target_tree.h"

#include <algorithm>
#include <limits>

namespace lobelia::gather {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

struct Bound {
  Vec3f centre{};
  float radius = 0, least = kNever;
};

// Reflectance at the peaks of all lobes, times weight.
float peakOf(const CutReceivers& receivers, int lane) {
  float peak = receivers.diffuse[lane];
  for (size_t i = 0; i < receivers.gaussianCount; ++i)
    peak += receivers.gaussians[i].amplitude[lane];
  return peak * receivers.weight[lane];
}

Bound boundOf(const CutReceivers& receivers, int lane, float least) {
  Bound bound{receivers.p.get(lane), receivers.placeSlack[lane], kNever};
  const float peak = peakOf(receivers, lane);
  if (peak > 0) bound.least = least / peak;
  return bound;
}

// Around those that something reaches; with room for rounding, so that what counts at a target does
// not depend on its neighbours.
Bound boundOf(const BoundStrip& strip) {
  constexpr float kRoom = 1e-4f;
  Bounds3f box;
  const auto forEach = [&](const auto& use) {
    for (int lane = 0; lane < kStrip; ++lane)
      if (strip.least[lane] < kNever) use(strip.centre.get(lane), strip.radius[lane], lane);
  };
  Bound bound;
  forEach([&](Vec3f p, float radius, int lane) {
    box.add(p - Vec3f(radius)), box.add(p + Vec3f(radius));
    bound.least = std::min(bound.least, strip.least[lane]);
  });
  if (!(bound.least < kNever)) return bound;
  bound.centre = box.centre();
  forEach([&](Vec3f p, float radius, int) {
    bound.radius = std::max(bound.radius, (1 + kRoom) * (length(p - bound.centre) + radius));
  });
  bound.least *= 1 - kRoom;
  return bound;
}

std::vector<BoundStrip> stripsOf(const std::vector<Bound>& bounds) {
  std::vector<BoundStrip> strips((bounds.size() + kStrip - 1) / kStrip);
  for (size_t i = 0; i < strips.size() * kStrip; ++i) {
    const Bound bound = i < bounds.size() ? bounds[i] : Bound();
    BoundStrip& strip = strips[i / kStrip];
    const int lane = static_cast<int>(i % kStrip);
    strip.centre.set(lane, bound.centre);
    strip.radius[lane] = bound.radius;
    strip.least[lane] = bound.least;
  }
  return strips;
}

}  // namespace

TargetTree::TargetTree(const std::vector<ClusterTarget>& all) : clusters(all) {
  std::vector<Bound> bounds;
  for (uint32_t c = 0; c < all.size(); ++c) {
    const ClusterTarget& cluster = all[c];
    if (cluster.representatives == 0) continue;
    const CutReceivers receivers = peaks(cluster.receivers, cluster.representatives);
    const int run = kStrip / cluster.representatives;
    for (int i = 0; i < kStrip; i += run) {
      if (!(receivers.weight[i] > 0)) continue;
      const int lane = static_cast<int>(bounds.size() % kStrip);
      if (lane == 0) strips.emplace_back();
      for (int to = lane; to < (lane == 0 ? kStrip : lane + 1); ++to)  // the first fills the others
        setLane(receivers, i, to, &strips.back());
      bounds.push_back(boundOf(receivers, i, cluster.least));
      targets.push_back(c);
    }
  }
  levels.push_back(stripsOf(bounds));
  while (levels.back().size() > 1) {
    bounds.clear();
    for (const BoundStrip& strip : levels.back()) bounds.push_back(boundOf(strip));
    levels.push_back(stripsOf(bounds));
  }
}

}  // namespace lobelia::gather
