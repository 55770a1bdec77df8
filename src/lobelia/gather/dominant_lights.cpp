#include "lobelia/gather/dominant_lights.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/target_tree.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/dominant_lights.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/node_importance-inl.h"

LOBELIA_CORE_BEGIN

constexpr float kFloor = g::CutSettings().floor;

// Directions about an axis, at most so far from it.
struct Cone {
  Vec3f axis{0, 0, 1};
  float cosine = 1, sine = 0;
  static Cone everywhere() { return {{0, 0, 1}, -1, 0}; }

  // Around unit vectors, with room for rounding.
  template <class Each>
  static Cone around(const Each& each) {
    constexpr float kRoom = 1e-5f;
    Vec3f sum;
    each([&](Vec3f v) { sum += v; });
    if (!(dot(sum, sum) > 1e-6f)) return everywhere();
    Cone cone{normalize(sum), 1, 0};
    each([&](Vec3f v) { cone.cosine = std::min(cone.cosine, dot(cone.axis, v)); });
    cone.cosine = std::max(cone.cosine - kRoom, -1.f);
    cone.sine = std::sqrt(1 - cone.cosine * cone.cosine);
    return cone;
  }
};

// What some lights may send at most, to find those that count from above.
struct SomeLights {
  Vec3f centre;
  float radius = 0;
  float variance = 0;  // the least
  // Either may be 0: lights that leave to the side of a normal, and on all sides. W/sr.
  float sided = 0, allAround = 0;
  Cone normals;
  float amplitude = 0, sharpness = 0;  // of Gaussians: the most, the least
  Cone axes;
};

float amplitudeOf(const trees::LightNode& light) {
  return light.glossy * (0.5f / kPi) * (light.sharpness + 0.5f);
}
bool onAllSides(const trees::LightNode& light) { return dot(light.n, light.n) < 0.5f; }

SomeLights lightOf(const trees::LightNode& light) {
  SomeLights one;
  one.centre = light.centre, one.variance = light.variance;
  // Of a light that leaves on all sides, `diffuse` is four times the mean.
  if (onAllSides(light)) {
    one.allAround = 0.25f * light.diffuse;
    one.normals = Cone::everywhere();
  } else {
    one.sided = light.diffuse;
    one.normals.axis = light.n;
  }
  one.amplitude = amplitudeOf(light), one.sharpness = light.sharpness;
  one.axes.axis = light.axis;
  return one;
}

// Of the leaves among the nodes.
SomeLights lightsOf(std::span<const trees::LightNode> nodes) {
  const auto forEach = [&](const auto& use) {
    for (const trees::LightNode& node : nodes)
      if (node.leaf()) use(node);
  };
  SomeLights some;
  some.variance = some.sharpness = kInfinityF;
  Bounds3f box;
  bool anyAround = false;
  forEach([&](const trees::LightNode& light) {
    const SomeLights one = lightOf(light);
    box.add(light.centre);
    some.variance = std::min(some.variance, one.variance);
    some.sided = std::max(some.sided, one.sided);
    some.allAround = std::max(some.allAround, one.allAround);
    some.amplitude = std::max(some.amplitude, one.amplitude);
    if (one.amplitude > 0) some.sharpness = std::min(some.sharpness, one.sharpness);
    anyAround |= onAllSides(light);
  });
  some.centre = box.centre();
  forEach([&](const trees::LightNode& light) {
    some.radius = std::max(some.radius, (1 + 1e-5f) * length(light.centre - some.centre));
  });
  some.normals = anyAround ? Cone::everywhere() : Cone::around([&](const auto& add) {
    forEach([&](const trees::LightNode& light) { add(light.n); });
  });
  if (some.amplitude > 0)
    some.axes = Cone::around([&](const auto& add) {
      forEach([&](const trees::LightNode& light) {
        if (light.glossy > 0) add(light.axis);
      });
    });
  return some;
}

// Of the targets of a strip, bit by bit: those that one of the lights may reach strongly enough.
class MayReach {
 public:
  // room: for rounding, where more than one light or target is meant.
  MayReach(const SomeLights& lights, float room) : lights_(lights), room_(room) {}

  // receivers: of the strip, where they are known, for what they may reflect; null: by their peaks.
  uint32_t operator()(const g::BoundStrip& strip, const g::CutReceivers* receivers) const {
    uint32_t bits = 0;
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes)
      bits |= maskBits(reached(strip, receivers, lane)) << lane;
    return bits;
  }

 private:
  HWY_INLINE Mf reached(const g::BoundStrip& strip, const g::CutReceivers* receivers,
                        size_t lane) const {
    const V3<Vf> d = load(strip.centre, lane) - broadcast(lights_.centre);
    const Vf radius = Vf::load(strip.radius + lane) + Vf(lights_.radius);
    const Vf distance = sqrt(dot(d, d));
    const Vf nearest = max(distance - radius, Vf(0.f));
    const Vf inverse = Vf(1.f) / max(distance, Vf(1e-20f));
    // Of half the angle that they take, seen from one another.
    const Vf sine = min(radius * inverse, Vf(1.f));
    const Vf cosine = sqrt(Vf(1.f) - sine * sine);
    const auto mostCosine = [&](V3<Vf> axis, Vf along) {
      const Vf c = min(max(dot(axis, d) * along, Vf(-1.f)), Vf(1.f));
      const Vf turned = c * cosine + sqrt(Vf(1.f) - c * c) * sine + Vf(room_);
      return select((nearest <= Vf(0.f)) | (c >= cosine), Vf(1.f), min(turned, Vf(1.f)));
    };
    const auto mostCosineOf = [&](const Cone& cone) {
      const Vf c = mostCosine(broadcast(cone.axis), inverse);
      if (!(cone.cosine < 1)) return c;
      const Vf turned = c * Vf(cone.cosine) + sqrt(Vf(1.f) - c * c) * Vf(cone.sine) + Vf(room_);
      return select(c >= Vf(cone.cosine), Vf(1.f), min(turned, Vf(1.f)));
    };
    const Vf c = mostCosineOf(lights_.normals);
    const Mf faces = c > Vf(0.f);
    Vf intensity = max(Vf(lights_.sided) * c, Vf(lights_.allAround));
    if (lights_.amplitude > 0)
      intensity += Vf(lights_.amplitude) *
                   exp(Vf(lights_.sharpness) * (mostCosineOf(lights_.axes) - Vf(1.f)));
    const Vf square = nearest * nearest + Vf(lights_.variance);
    const Vf least = Vf::load(strip.least + lane) * square;
    const Mf enough = faces & (least < Vf(kInfinityF)) & (intensity >= least);
    if (receivers == nullptr || !any(enough)) return enough;
    // As nodeImportance() has it.
    const Vf diffuse = Vf::load(receivers->diffuse + lane);
    const V3<Vf> n = load(receivers->n, lane);
    const Vf up = mostCosine(n, Vf(0.f) - inverse), down = mostCosine(n, inverse);
    Vf reflected = diffuse * max(max(Vf::load(receivers->above + lane) * up,
                                     Vf::load(receivers->below + lane) * down),
                                 Vf(0.f));
    Vf peak = diffuse;
    const Vf wide = Vf::load(receivers->variance + lane) / max(square, Vf(1e-20f));
    for (size_t i = 0; i < receivers->gaussianCount; ++i) {
      const g::GaussianStrip& lobe = receivers->gaussians[i];
      const Vf k = Vf::load(lobe.sharpness + lane), a = Vf::load(lobe.amplitude + lane);
      const Vf narrow = Vf(1.f) / (Vf(1.f) + k * wide);
      reflected +=
          a * narrow *
          exp(k * narrow * (mostCosine(load(lobe.axis, lane), Vf(0.f) - inverse) - Vf(1.f)));
      peak += a;
    }
    return enough & (intensity * (reflected + Vf(kFloor) * peak) >= least * peak);
  }

  const SomeLights lights_;
  const float room_;
};

// Does a light reach the receivers of a cluster so, as far as estimates tell?
class Reaches {
 public:
  explicit Reaches(const trees::LightNode& light) : light_(light) {}

  // The root of the sum of squares over receivers, as cuts are chosen by it.
  bool operator()(const g::ClusterTarget& cluster) {
    if (!filled_) {
      const trees::LightNode* light = &light_;
      table_.fill({&light, 1}, 1);
      filled_ = true;
    }
    alignas(64) float values[g::kStrip];
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes)
      nodeImportance(table_.at(lane), cluster.receivers, lane, Vf(kFloor), Vf(1.f), nullptr)
          .store(values + lane);
    float squares = 0;
    for (const float value : values) squares += value * value;
    return std::sqrt(squares) >= cluster.least;
  }

 private:
  const trees::LightNode& light_;
  bool filled_ = false;
  NodeTable table_;
};

// What the lights of runs of neighbours reach.
class Search {
 public:
  Search(const g::TargetTree& tree, std::span<const trees::LightNode> nodes,
         std::vector<g::Reached>* reached)
      : tree_(tree), nodes_(nodes), reached_(*reached) {}

  // All lights below a node: together down to the targets' strips, then fewer, then each alone.
  void run(uint32_t root) {
    narrow(lightsOf(below(root)));
    if (strips_.empty()) return;
    const uint32_t end = root + 2 * nodes_[root].count - 1;
    for (uint32_t node = root; node < end;) {
      const uint32_t count = nodes_[node].count;
      if (count > kFew) {
        ++node;
        continue;
      }
      if (count == 1)
        few_ = strips_;
      else
        narrowFew(lightsOf(below(node)));
      if (!few_.empty())
        for (const trees::LightNode& light : below(node))
          if (light.leaf()) runLight(light);
      node += 2 * count - 1;
    }
  }
  uint64_t comparisons() const { return g::kStrip * compared_; }

 private:
  static constexpr uint32_t kFew = 8;
  static constexpr float kRoom = 1e-5f;
  struct Strip {
    uint32_t level, index;
  };
  struct Candidates {
    uint32_t strip, bits;
  };

  std::span<const trees::LightNode> below(uint32_t node) const {
    return nodes_.subspan(node, 2 * size_t{nodes_[node].count} - 1);
  }

  void narrow(const SomeLights& lights) {
    const MayReach mayReach(lights, kRoom);
    strips_.clear();
    stack_.assign(1, {static_cast<uint32_t>(tree_.levels.size() - 1), 0});
    while (!stack_.empty()) {
      const Strip at = stack_.back();
      stack_.pop_back();
      ++compared_;
      uint32_t bits = mayReach(tree_.levels[at.level][at.index],
                               at.level == 0 ? &tree_.strips[at.index] : nullptr);
      if (at.level == 0) {
        if (bits != 0) strips_.push_back({at.index, bits});
        continue;
      }
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<uint32_t>(__builtin_ctz(bits));
        stack_.push_back({at.level - 1, at.index * g::kStrip + lane});
      }
    }
  }

  void narrowFew(const SomeLights& lights) {
    const MayReach mayReach(lights, kRoom);
    few_.clear();
    for (const Candidates& at : strips_) {
      ++compared_;
      const uint32_t bits = at.bits & mayReach(tree_.levels[0][at.strip], &tree_.strips[at.strip]);
      if (bits != 0) few_.push_back({at.strip, bits});
    }
  }

  void runLight(const trees::LightNode& light) {
    const MayReach mayReach(lightOf(light), 0);
    Reaches reaches(light);
    for (const Candidates& at : few_) {
      ++compared_;
      uint32_t bits = at.bits & mayReach(tree_.levels[0][at.strip], &tree_.strips[at.strip]);
      uint32_t last = ~0u;  // of a cluster's representatives, which are neighbours, one will do
      for (; bits != 0; bits &= bits - 1) {
        const uint32_t cluster =
            tree_.targets[at.strip * g::kStrip + static_cast<uint32_t>(__builtin_ctz(bits))];
        if (std::exchange(last, cluster) == cluster) continue;
        ++compared_;
        if (reaches(tree_.clusters[cluster]))
          reached_.push_back({cluster, static_cast<uint32_t>(&light - nodes_.data())});
      }
    }
  }

  const g::TargetTree& tree_;
  const std::span<const trees::LightNode> nodes_;
  std::vector<g::Reached>& reached_;
  std::vector<Strip> stack_;
  std::vector<Candidates> strips_, few_;
  uint64_t compared_ = 0;
};

// Appends what the lights below the roots reach; returns the number of pairs compared.
uint64_t findReached(const g::TargetTree& tree, std::span<const trees::LightNode> nodes,
                     std::span<const uint32_t> roots, std::vector<g::Reached>* reached) {
  Search search(tree, nodes, reached);
  for (const uint32_t root : roots) search.run(root);
  return search.comparisons();
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(findReached);
}  // namespace lobelia

namespace lobelia::gather {
namespace {

constexpr uint32_t kTogether = 32;  // lights that look for targets together, at most

// Of the largest subtrees with so few lights.
std::vector<uint32_t> rootsOf(std::span<const trees::LightNode> nodes) {
  std::vector<uint32_t> roots;
  for (uint32_t node = 0; node < nodes.size();) {
    const uint32_t count = nodes[node].count;
    if (count > kTogether) {
      ++node;
    } else {
      roots.push_back(node);
      node += 2 * count - 1;
    }
  }
  return roots;
}

}  // namespace

DominantLights::DominantLights(const std::vector<ClusterTarget>& clusters,
                               std::span<const trees::LightTree> trees, const Context& context)
    : begins_(clusters.size() + 1, 0) {
  const TargetTree tree(clusters);
  if (tree.targets.empty()) return;
  constexpr size_t kGrain = 128;
  struct Part {
    uint32_t tree;
    std::vector<Reached> reached;
    uint64_t comparisons = 0;
  };
  std::vector<Part> parts;
  for (uint32_t t = 0; t < trees.size(); ++t) {
    const auto nodes = trees[t].nodes();
    const std::vector<uint32_t> roots = rootsOf(nodes);
    const size_t first = parts.size();
    parts.resize(first + (roots.size() + kGrain - 1) / kGrain, Part{t, {}, 0});
    parallelRanges(roots.size(), kGrain, [&](size_t begin, size_t end) {
      if (context.cancelled()) return;
      Part& part = parts[first + begin / kGrain];
      part.comparisons = HWY_DYNAMIC_DISPATCH(lobelia::findReached)(
          tree, nodes, std::span(roots).subspan(begin, end - begin), &part.reached);
      // Representatives of a cluster may be in two strips.
      std::sort(part.reached.begin(), part.reached.end());
      part.reached.erase(std::unique(part.reached.begin(), part.reached.end()), part.reached.end());
    });
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
