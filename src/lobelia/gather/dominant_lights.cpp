#include "lobelia/gather/dominant_lights.h"

#include <algorithm>
#include <limits>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/target_tree.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/dominant_lights.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/node_importance-inl.h"

LOBELIA_CORE_BEGIN

// A light on its way down a tree of targets.
class Reaching {
 public:
  explicit Reaching(const trees::LightNode& light)
      : light_(light),
        amplitude_(light.glossy * (0.5f / kPi) * (light.sharpness + 0.5f)),
        onAllSides_(dot(light.n, light.n) < 0.5f) {}

  // Of the targets of a strip, bit by bit: those that the light may reach strongly enough.
  // above: the strip is one of strips.
  uint32_t mayReach(const g::BoundStrip& strip, bool above) const {
    // A difference of rounding, so that what a target has does not depend on its neighbours.
    const Vf room(above ? 1e-6f : 0.f);
    uint32_t bits = 0;
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes)
      bits |= maskBits(mayReach(strip, lane, room)) << lane;
    return bits;
  }
  // Those that it does reach so, as far as estimates tell.
  uint32_t reaches(const g::TargetStrip& strip) {
    if (!filled_) {
      const trees::LightNode* light = &light_;
      table_.fill({&light, 1}, 1);
      filled_ = true;
    }
    uint32_t bits = 0;
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
      const Vf value =
          nodeImportance(table_.at(lane), strip.receivers, lane, Vf(kFloor), Vf(1.f), nullptr);
      bits |= maskBits(value >= Vf::load(strip.least + lane)) << lane;
    }
    return bits;
  }

 private:
  static constexpr float kFloor = 0.01f;  // as CutSettings::floor

  HWY_INLINE Mf mayReach(const g::BoundStrip& strip, size_t lane, Vf room) const {
    const V3<Vf> d = load(strip.centre, lane) - broadcast(light_.centre);
    const Vf radius = Vf::load(strip.radius + lane);
    const Vf distance = sqrt(dot(d, d));
    const Vf nearest = max(distance - radius, Vf(0.f));
    const Vf inverse = Vf(1.f) / max(distance, Vf(1e-20f));
    // Of half the angle that the targets take.
    const Vf sine = min(radius * inverse, Vf(1.f));
    const Vf cosine = sqrt(Vf(1.f) - sine * sine);
    const auto mostCosine = [&](Vec3f axis) {
      const Vf c = min(max(dot(broadcast(axis), d) * inverse, Vf(-1.f)), Vf(1.f));
      const Vf turned = c * cosine + sqrt(Vf(1.f) - c * c) * sine + room;
      return select((nearest <= Vf(0.f)) | (c >= cosine), Vf(1.f), turned);
    };
    // Of a light that leaves on all sides, `diffuse` is four times the mean.
    Vf intensity(0.25f * light_.diffuse);
    Mf faces = Vf(0.f) == Vf(0.f);
    if (!onAllSides_) {
      const Vf c = mostCosine(light_.n);
      faces = c > Vf(0.f);
      intensity = Vf(light_.diffuse) * c;
    }
    if (light_.glossy > 0)
      intensity += Vf(amplitude_) * exp(Vf(light_.sharpness) * (mostCosine(light_.axis) - Vf(1.f)));
    return faces &
           (intensity >= Vf::load(strip.least + lane) * (nearest * nearest + Vf(light_.variance)));
  }

  const trees::LightNode& light_;
  const float amplitude_;
  const bool onAllSides_;
  bool filled_ = false;
  NodeTable table_;
};

// Appends what the leaves of nodes[begin, end) reach; returns the number of pairs compared.
uint64_t findReached(const g::TargetTree& tree, std::span<const trees::LightNode> nodes,
                     size_t begin, size_t end, std::vector<g::Reached>* reached) {
  struct Strip {
    uint32_t level, index;
  };
  std::vector<Strip> stack;
  uint64_t strips = 0;
  for (size_t node = begin; node < end; ++node) {
    if (!nodes[node].leaf()) continue;
    Reaching light(nodes[node]);
    stack.push_back({static_cast<uint32_t>(tree.levels.size() - 1), 0});
    while (!stack.empty()) {
      const Strip at = stack.back();
      stack.pop_back();
      ++strips;
      uint32_t bits = light.mayReach(tree.levels[at.level][at.index], at.level > 0);
      if (bits != 0 && at.level == 0) {
        ++strips;
        bits &= light.reaches(tree.targets[at.index]);
      }
      for (; bits != 0; bits &= bits - 1) {
        const uint32_t child = at.index * g::kStrip + static_cast<uint32_t>(__builtin_ctz(bits));
        if (at.level > 0)
          stack.push_back({at.level - 1, child});
        else
          reached->push_back({tree.clusters[child], static_cast<uint32_t>(node)});
      }
    }
  }
  return strips * g::kStrip;
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(findReached);
}  // namespace lobelia

namespace lobelia::gather {

DominantLights::DominantLights(const std::vector<ClusterTarget>& clusters,
                               std::span<const trees::LightTree> trees, const Context& context)
    : begins_(clusters.size() + 1, 0) {
  const TargetTree tree(clusters);
  if (tree.clusters.empty()) return;
  constexpr size_t kGrain = 4096;
  struct Part {
    uint32_t tree;
    std::vector<Reached> reached;
    uint64_t comparisons = 0;
  };
  std::vector<Part> parts;
  for (uint32_t t = 0; t < trees.size(); ++t) {
    const auto nodes = trees[t].nodes();
    const size_t first = parts.size();
    parts.resize(first + (nodes.size() + kGrain - 1) / kGrain, Part{t, {}, 0});
    parallelRanges(nodes.size(), kGrain, [&](size_t begin, size_t end) {
      if (context.cancelled()) return;
      Part& part = parts[first + begin / kGrain];
      part.comparisons =
          HWY_DYNAMIC_DISPATCH(lobelia::findReached)(tree, nodes, begin, end, &part.reached);
    });
  }
  // A light may reach several representatives of a cluster.
  for (Part& part : parts) {
    std::sort(part.reached.begin(), part.reached.end());
    part.reached.erase(std::unique(part.reached.begin(), part.reached.end()), part.reached.end());
  }
  for (const Part& part : parts) comparisons_ += part.comparisons;
  for (const Part& part : parts)
    for (const Reached& light : part.reached) ++begins_[light.cluster + 1];
  for (size_t i = 0; i < clusters.size(); ++i) begins_[i + 1] += begins_[i];
  leaves_.resize(begins_.back());
  std::vector<size_t> ends(begins_.begin(), begins_.end() - 1);
  for (const Part& part : parts)
    for (const Reached& light : part.reached)
      leaves_[ends[light.cluster]++] = {part.tree, light.node};
}

}  // namespace lobelia::gather
#endif
