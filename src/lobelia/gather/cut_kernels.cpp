#include "lobelia/gather/cut_kernels.h"

#include <algorithm>

#include "lobelia/base/random.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/cut_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/visibility-inl.h"

LOBELIA_CORE_BEGIN

using trees::LightNode;
using trees::LightTree;

// [x]+ where x is known to spread by about sqrt(spread).
HWY_INLINE Vf smoothPositive(Vf x, Vf spread) { return Vf(0.5f) * (x + sqrt(x * x + spread)); }

// What a node contributes to the points of a strip, roughly: radiant intensity times reflectance
// over squared distance, both ends' lobes widened by the angle at which the node's lights appear;
// the root of the sum of squares over the points, each with its weight. That is what the
// probability of a light that all points share should be in proportion to. 0 only where nothing is
// contributed.
class Importance {
 public:
  Importance(const g::CutReceivers& receivers, std::span<const LightTree> trees, float floor)
      : receivers_(receivers),
        strip_(receivers.tile.strips[0]),
        sampling_(receivers.tile.sampling[0]),
        floor_(floor) {
    // Over the roots', so that no square underflows.
    Vf total(0.f), unused;
    for (const LightTree& tree : trees) {
      if (tree.empty()) continue;
      for (size_t lane = 0; lane < g::kStrip; lane += kLanes)
        total += at(tree.nodes()[0], lane, &unused);
    }
    const float sum = hn::GetLane(hn::SumOfLanes(Df(), total.v));
    if (sum > 0 && 1 / sum < kInfinityF) scale_ = 1 / sum;
  }

  // priority: the same times the relative deviation of what the node's lights contribute, roughly.
  float operator()(const LightNode& node, float* priority = nullptr) {
    ++evaluations_;
    Vf total(0.f), weighted(0.f), variance;
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
      const Vf value = at(node, lane, &variance);
      total += value * value;
      weighted += value * value * variance;
    }
    if (priority != nullptr) *priority = std::sqrt(hn::GetLane(hn::SumOfLanes(Df(), weighted.v)));
    return std::sqrt(hn::GetLane(hn::SumOfLanes(Df(), total.v)));
  }
  size_t evaluations() const { return evaluations_; }

 private:
  HWY_INLINE Vf at(const LightNode& node, size_t lane, Vf* relativeVariance) const {
    const V3<Vf> n = load(strip_.n, lane);
    const V3<Vf> d = broadcast(node.centre) - load(strip_.p, lane);
    const Vf height = dot(n, d), radius(node.radius);
    const Vf above = Vf::load(strip_.above + lane), below = Vf::load(strip_.below + lane);
    Mf faces = ((height + radius) * above > Vf(0.f)) | ((height - radius) * below < Vf(0.f));
    if (node.leaf()) {
      const Vf leaving = dot(broadcast(node.n), d);
      faces = faces & !(leaving > Vf(0.f));
    }
    *relativeVariance = Vf(0.f);
    if (!any(faces)) return Vf(0.f);

    const Vf variance(node.variance);
    const Vf inverse = Vf(1.f) / (dot(d, d) + variance + Vf(1e-20f));
    const V3<Vf> w = d * sqrt(inverse);  // shorter than 1 where the node is wide
    const Vf wide = variance * inverse;
    const Vf floor(floor_);
    // Cosine lobes of both ends.
    const Vf c = dot(n, w), spread = Vf(0.25f) * wide;
    const Vf diffuse = Vf::load(sampling_.diffuse + lane);
    const Vf reflected =
        diffuse * (above * smoothPositive(c, spread) + below * smoothPositive(Vf(0.f) - c, spread));
    Vf leaving(0.f);
    if (node.diffuse > 0) {
      const Vf disagreement = Vf(1.f) - Vf(dot(node.n, node.n)) * (Vf(1.f) - wide);
      leaving = Vf(node.diffuse) * smoothPositive(Vf(0.f) - dot(broadcast(node.n), w),
                                                  max(Vf(0.25f) * disagreement, Vf(0.f)));
    }
    Vf total = leaving * reflected, slope(0.f);
    Vf light = leaving, lightPeak(node.diffuse), receiver = reflected, receiverPeak = diffuse;
    // The lights' Gaussian over the receivers' cosine.
    const Vf sharpness(node.sharpness);
    const Vf amplitude(node.glossy * (0.5f / kPi) * (node.sharpness + 0.5f));
    const V3<Vf> back = broadcast(-node.axis);
    const bool glossy = node.glossy > 0;
    if (glossy) {
      const Vf narrow = Vf(1.f) / (Vf(1.f) + sharpness * wide);
      const Vf peak = amplitude * narrow;
      const Vf widened = peak * exp(sharpness * narrow * (dot(back, w) - Vf(1.f)));
      light += widened;
      lightPeak += peak;
      total += widened * reflected;
      slope += widened * reflected * sharpness;
    }
    for (size_t i = 0; i < strip_.gaussianCount; ++i) {
      const g::GaussianStrip& lobe = receivers_.tile.gaussians[strip_.firstGaussian + i];
      const V3<Vf> axis = load(lobe.axis, lane);
      const Vf k = Vf::load(lobe.sharpness + lane), a = Vf::load(lobe.amplitude + lane);
      const Vf narrow = Vf(1.f) / (Vf(1.f) + k * wide);
      const Vf widened = a * narrow * exp(k * narrow * (dot(axis, w) - Vf(1.f)));
      receiver += widened;
      receiverPeak += a * narrow;
      total += leaving * widened;
      slope += leaving * widened * k;
      if (!glossy) continue;
      // The product of both Gaussians is one, which the node's width widens.
      const V3<Vf> v = back * sharpness + axis * k;
      const Vf length = sqrt(dot(v, v)), sum = length + sharpness + k;
      const Vf narrower = Vf(1.f) / (Vf(1.f) + length * wide);
      const Vf apart = sharpness * k * squaredDistance(back, axis) / max(sum, Vf(1e-20f));
      const Vf part = amplitude * a * narrower * exp(narrower * (dot(v, w) - length) - apart);
      total += part;
      slope += part * length;
    }
    total += floor * (light * receiverPeak + lightPeak * (receiver + floor * receiverPeak));
    // Relative variance within the node: by distance, and by the slopes of the lobes.
    const Vf slopes = slope / max(total, Vf(1e-30f));
    *relativeVariance = min(Vf(kLeastVariance) + wide * (Vf(1.f) + slopes), Vf(1.f));
    const Vf weight = Vf::load(receivers_.weight + lane) * Vf(scale_);
    // Squares neither vanish nor overflow.
    const Vf value = min(max(weight * total * inverse, Vf(1e-18f)), Vf(1e18f));
    return select(faces & (weight > Vf(0.f)), value, Vf(0.f));
  }

  static constexpr float kLeastVariance = 0.02f;  // of visibility, and where the estimate is wrong
  const g::CutReceivers& receivers_;
  const g::PointStrip& strip_;
  const g::SamplingStrip& sampling_;
  const float floor_;
  float scale_ = 1;
  size_t evaluations_ = 0;
};

using Entry = g::CutScratch::Entry;

// Splits the node of the highest priority until the cut is as large as it may be. Afterwards `done`
// has the cut. Nodes that contribute nothing are left out.
void growCut(std::span<const LightTree> trees, size_t most, Importance* importance,
             g::CutScratch* scratch) {
  std::vector<Entry>&heap = scratch->heap, &done = scratch->done;
  heap.clear(), done.clear();
  const auto less = [](const Entry& a, const Entry& b) {
    if (a.priority != b.priority) return a.priority < b.priority;
    return a.tree != b.tree ? a.tree > b.tree : a.node > b.node;
  };
  const auto add = [&](uint32_t tree, uint32_t i) {
    const LightNode& node = trees[tree].nodes()[i];
    float priority = 0;
    const float value = (*importance)(node, &priority);
    if (!(value > 0)) return;
    if (node.leaf()) {
      done.push_back({value, tree, i});
    } else {
      heap.push_back({priority, tree, i});
      std::push_heap(heap.begin(), heap.end(), less);
    }
  };
  for (uint32_t tree = 0; tree < trees.size(); ++tree)
    if (!trees[tree].empty()) add(tree, 0);
  while (!heap.empty() && heap.size() + done.size() < most) {
    std::pop_heap(heap.begin(), heap.end(), less);
    const Entry split = heap.back();
    heap.pop_back();
    add(split.tree, trees[split.tree].left(split.node));
    add(split.tree, trees[split.tree].right(split.node));
  }
  done.insert(done.end(), heap.begin(), heap.end());
}

// From a node down to one of its lights, children by their importance. False: none contributes.
bool descend(const LightTree& tree, uint32_t node, double u, Importance* importance,
             g::CutLight* light) {
  double probability = 1;
  const auto nodes = tree.nodes();
  while (!nodes[node].leaf()) {
    const uint32_t left = tree.left(node), right = tree.right(node);
    const double a = double{(*importance)(nodes[left])}, b = double{(*importance)(nodes[right])};
    if (!(a + b > 0)) return false;
    const double share = a / (a + b);
    if (u < share) {
      u /= share;
      probability *= share;
      node = left;
    } else {
      u = std::min((u - share) / (1 - share), 0x1.fffffffffffffp-1);
      probability *= 1 - share;
      node = right;
    }
  }
  *light = {tree.light(nodes[node].first), static_cast<float>(probability)};
  return true;
}

size_t drawCutLights(const g::CutReceivers& receivers, std::span<const LightTree> trees,
                     const g::CutSettings& settings, uint64_t seed, g::CutScratch* scratch,
                     std::vector<g::CutLight>* lights) {
  lights->clear();
  Importance importance(receivers, trees, settings.floor);
  growCut(trees, settings.nodes, &importance, scratch);
  std::sort(scratch->done.begin(), scratch->done.end(), [](const Entry& a, const Entry& b) {
    return a.tree != b.tree ? a.tree < b.tree : a.node < b.node;
  });
  for (const Entry& entry : scratch->done) {
    const uint64_t key = hashCombine(seed, uint64_t{entry.tree} << 32 | entry.node);
    const double u = static_cast<double>(key >> 11) * 0x1p-53;
    g::CutLight light;
    if (descend(trees[entry.tree], entry.node, u, &importance, &light)) lights->push_back(light);
  }
  return importance.evaluations();
}

template <g::LightClass kClass>
uint32_t facingPoints(const g::Tile& tile, const g::PreparedLight& light) {
  uint32_t bits = 0;
  const g::PointStrip& strip = tile.strips[0];
  for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
    const V3<Vf> d = toLight<kClass>(light, load(strip.p, lane));
    bits |= maskBits(lightFaces<kClass>(light, d) & receiverFaces(strip, lane, d)) << lane;
  }
  return bits;
}

template <g::LightClass kClass>
size_t keepVisibleByOneOf(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                          uint64_t seed, g::PairMasks* pairs) {
  uint16_t facing[g::kBlockLights];
  for (size_t l = 0; l < static_cast<size_t>(block.count); ++l) {
    const uint32_t bits = pairs->at(l, 0) & facingPoints<kClass>(tile, block.lights[l]);
    facing[l] = static_cast<uint16_t>(bits);
    pairs->at(l, 0) = 0;
    if (bits == 0) continue;
    const uint64_t random = hashCombine(seed, l) >> 32;
    uint32_t skip =
        static_cast<uint32_t>(random * static_cast<uint64_t>(__builtin_popcount(bits)) >> 32);
    uint32_t rest = bits;
    for (; skip > 0; --skip) rest &= rest - 1;
    pairs->at(l, 0) = static_cast<uint16_t>(rest & (~rest + 1));
  }
  const size_t rays = keepVisibleOf<kClass>(tile, block, tracer, pairs);
  for (size_t l = 0; l < static_cast<size_t>(block.count); ++l)
    if (pairs->at(l, 0) != 0) pairs->at(l, 0) = facing[l];
  return rays;
}

size_t keepVisibleByOne(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                        uint64_t seed, g::PairMasks* pairs) {
  switch (block.lightClass) {
    case g::LightClass::omni:
      return keepVisibleByOneOf<g::LightClass::omni>(tile, block, tracer, seed, pairs);
    case g::LightClass::directional:
      return keepVisibleByOneOf<g::LightClass::directional>(tile, block, tracer, seed, pairs);
    case g::LightClass::diffuse:
      return keepVisibleByOneOf<g::LightClass::diffuse>(tile, block, tracer, seed, pairs);
    case g::LightClass::spherical:
      return keepVisibleByOneOf<g::LightClass::spherical>(tile, block, tracer, seed, pairs);
    case g::LightClass::glossy:
      break;
  }
  return keepVisibleByOneOf<g::LightClass::glossy>(tile, block, tracer, seed, pairs);
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(drawCutLights);
HWY_EXPORT(keepVisibleByOne);
}  // namespace lobelia

namespace lobelia::gather {

size_t drawCutLights(const CutReceivers& receivers, std::span<const trees::LightTree> trees,
                     const CutSettings& settings, uint64_t seed, CutScratch* scratch,
                     std::vector<CutLight>* lights) {
  return HWY_DYNAMIC_DISPATCH(lobelia::drawCutLights)(receivers, trees, settings, seed, scratch,
                                                      lights);
}

size_t keepVisibleByOne(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                        uint64_t seed, PairMasks* pairs) {
  return HWY_DYNAMIC_DISPATCH(lobelia::keepVisibleByOne)(tile, block, tracer, seed, pairs);
}

}  // namespace lobelia::gather
#endif
