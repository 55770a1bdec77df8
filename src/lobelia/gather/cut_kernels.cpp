#include "lobelia/gather/cut_kernels.h"

#include <algorithm>

#include "hwy/cache_control.h"
#include "lobelia/base/random.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/cut_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/gather/node_importance-inl.h"

LOBELIA_CORE_BEGIN

using trees::LightNode;
using trees::LightTree;

using Entry = g::CutScratch::Entry;

// The root of the sum of squares of nodeImportance() over representatives of the receivers: what
// the probability of a light that all receivers share should be in proportion to.
class Importance {
 public:
  Importance(const g::CutReceivers& receivers, int representatives,
             std::span<const LightTree> trees, float floor)
      : receivers_(g::representatives(receivers, representatives)),
        most_(g::kStrip / static_cast<size_t>(representatives)),
        floor_(floor) {
    // Over the roots', so that no square underflows.
    float sum = 0;
    for (const LightTree& tree : trees) {
      if (tree.empty()) continue;
      const LightNode* root = tree.nodes().data();
      float value;
      evaluate({&root, 1}, &value);
      sum += value;
    }
    if (sum > 0 && 1 / sum < kInfinityF) scale_ = 1 / sum;
  }
  // On the scale of another one.
  Importance(const g::CutReceivers& receivers, int representatives, float floor, float scale)
      : receivers_(g::representatives(receivers, representatives)),
        most_(g::kStrip / static_cast<size_t>(representatives)),
        floor_(floor),
        scale_(scale) {}
  float scale() const { return scale_; }

  // values, priorities: of each node; the latter the same times the relative deviation of what the
  // node's lights contribute, roughly.
  void evaluate(std::span<const LightNode* const> nodes, float* values,
                float* priorities = nullptr) {
    for (size_t begin = 0; begin < nodes.size(); begin += most_) {
      const auto run = nodes.subspan(begin, std::min(most_, nodes.size() - begin));
      if (priorities == nullptr)
        evaluateRun<false>(run, values + begin, nullptr);
      else
        evaluateRun<true>(run, values + begin, priorities + begin);
    }
    evaluations_ += nodes.size();
  }
  size_t evaluations() const { return evaluations_; }

 private:
  // A lane for every representative and node.
  template <bool kPriorities>
  HWY_INLINE void evaluateRun(std::span<const LightNode* const> nodes, float* values,
                              float* priorities) {
    table_.fill(nodes, most_);
    alignas(64) float squares[g::kStrip], weighted[g::kStrip];
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
      Vf variance;
      const Vf value = nodeImportance(table_.at(lane), receivers_, lane, floor_, scale_,
                                      kPriorities ? &variance : nullptr);
      const Vf square = value * value;
      square.store(squares + lane);
      if (kPriorities) (square * variance).store(weighted + lane);
    }
    sumRepresentatives(squares, nodes.size(), values);
    if (kPriorities) sumRepresentatives(weighted, nodes.size(), priorities);
  }
  // Roots of the sums.
  HWY_INLINE void sumRepresentatives(float* lanes, size_t count, float* roots) const {
    for (size_t half = g::kStrip / 2; half >= most_; half /= 2)
      for (size_t i = 0; i < half; ++i) lanes[i] += lanes[i + half];
    for (size_t i = 0; i < count; ++i) roots[i] = std::sqrt(lanes[i]);
  }

  const g::CutReceivers receivers_;
  const size_t most_;  // nodes at once
  const float floor_;
  float scale_ = 1;
  NodeTable table_;
  size_t evaluations_ = 0;
};

// The error of what is gathered is about so many times what estimates say (docs/performance.md,
// "An error aimed at"): they know neither what hides lights nor how wrong they are. Of several
// representatives, nodes' roots of sums of squares add up to more than all there is, up to twice as
// much for four.
constexpr double kErrorPerDeviation = 3;
// Estimates of fewer nodes say nothing about an error.
constexpr size_t kLeastNodes = 64;

// Splits nodes of the highest priority, a few at a time, until the cut is as large as it may be, or
// as its error asks for. Afterwards `done` has the cut. Nodes that contribute nothing are left out.
class CutGrowth {
 public:
  CutGrowth(std::span<const LightTree> trees, Importance* importance, g::CutScratch* scratch)
      : trees_(trees), importance_(*importance), heap_(scratch->heap), done_(scratch->done) {
    heap_.clear(), done_.clear();
  }

  // error: CutSettings. Was it met?
  bool run(size_t most, float error = 0) {
    for (uint32_t tree = 0; tree < trees_.size(); ++tree) {
      if (trees_[tree].empty()) continue;
      children_[0] = {0, 0, tree, 0};
      add(1);
    }
    bool met = false;
    while (!(met = meets(error)) && heap_.size() + done_.size() < most) {
      const size_t splits = std::min({kAtOnce, heap_.size(), most - heap_.size() - done_.size()});
      for (size_t i = 0; i < splits; ++i) {
        std::pop_heap(heap_.begin(), heap_.end(), less);
        const Entry split = heap_.back();
        heap_.pop_back();
        book(split, -1);
        const LightTree& tree = trees_[split.tree];
        children_[2 * i] = {0, 0, split.tree, tree.left(split.node)};
        children_[2 * i + 1] = {0, 0, split.tree, tree.right(split.node)};
      }
      add(2 * splits);
    }
    done_.insert(done_.end(), heap_.begin(), heap_.end());
    return met;
  }

 private:
  static constexpr size_t kAtOnce = 8;

  void book(const Entry& entry, double sign) {
    all_ += sign * double{entry.importance};
    variance_ += sign * sqr(double{entry.priority});
  }
  // With nothing left to split it is met.
  bool meets(float error) {
    if (heap_.empty()) return true;
    if (!(error > 0) || heap_.size() + done_.size() < kLeastNodes) return false;
    const double most = sqr(double{error} / kErrorPerDeviation * all_);
    if (variance_ > most) return false;
    // What is left of large terms that came and went must not decide.
    variance_ = 0;
    for (const Entry& entry : heap_) variance_ += sqr(double{entry.priority});
    return variance_ <= most;
  }

  static bool less(const Entry& a, const Entry& b) {
    if (a.priority != b.priority) return a.priority < b.priority;
    return a.tree != b.tree ? a.tree > b.tree : a.node > b.node;
  }

  void add(size_t count) {
    const LightNode* nodes[2 * kAtOnce];
    for (size_t i = 0; i < count; ++i)
      nodes[i] = trees_[children_[i].tree].nodes().data() + children_[i].node;
    float values[2 * kAtOnce], priorities[2 * kAtOnce];
    importance_.evaluate({nodes, count}, values, priorities);
    for (size_t i = 0; i < count; ++i) {
      if (!(values[i] > 0)) continue;
      Entry entry = children_[i];
      entry.importance = values[i];
      if (nodes[i]->leaf()) {
        done_.push_back(entry);
        book(entry, 1);
      } else {
        entry.priority = priorities[i];
        book(entry, 1);
        heap_.push_back(entry);
        std::push_heap(heap_.begin(), heap_.end(), less);
      }
    }
  }

  const std::span<const LightTree> trees_;
  Importance& importance_;
  std::vector<Entry>&heap_, &done_;
  double all_ = 0, variance_ = 0;  // of the cut
  Entry children_[2 * kAtOnce];
};

// From nodes of a cut down to one light each, children by their importance; several descents side
// by side, so that memory is waited for together.
class Descents {
 public:
  Descents(const LightTree& tree, std::span<const Entry> entries, uint64_t seed,
           std::span<const g::DominantLights::Leaf> dominant, Importance* importance,
           std::vector<g::CutLight>* drawn)
      : tree_(tree),
        entries_(entries),
        dominant_(dominant),
        seed_(seed),
        importance_(*importance),
        drawn_(*drawn) {}

  // Appends the lights of the entries, all of one tree, in their order. A node none of whose lights
  // contributes leaves none, nor does one of whose lights a dominant one is drawn.
  void run(std::vector<g::CutLight>* lights) {
    drawn_.assign(entries_.size(), {0, 0, 0});
    for (refill(); count_ > 0; refill()) step();
    // Numbers of the lights, which so far are places: memory is waited for together.
    const size_t first = lights->size();
    for (const g::CutLight& light : drawn_) {
      if (!(light.probability > 0)) continue;
      hwy::Prefetch(tree_.lightAt(light.number));
      lights->push_back(light);
    }
    for (size_t i = first; i < lights->size(); ++i) {
      g::CutLight& light = (*lights)[i];
      light.number = *tree_.lightAt(light.number);
    }
  }

 private:
  static constexpr size_t kSideBySide = 32;
  struct Descent {
    uint32_t node;
    size_t entry;
    double probability, u;
    float importance;
  };

  void refill() {
    for (; count_ < kSideBySide && next_ < entries_.size(); ++next_) {
      const Entry& entry = entries_[next_];
      const uint64_t key = hashCombine(seed_, uint64_t{entry.tree} << 32 | entry.node);
      keep({entry.node, next_, 1, static_cast<double>(key >> 11) * 0x1p-53, entry.importance});
    }
  }

  // At a leaf it notes its light.
  void keep(const Descent& at) {
    const LightNode& node = tree_.nodes()[at.node];
    if (node.leaf()) {
      if (std::binary_search(dominant_.begin(), dominant_.end(),
                             g::DominantLights::Leaf{entries_[at.entry].tree, at.node}))
        return;
      const float probability = static_cast<float>(at.probability);
      drawn_[at.entry] = {node.link, probability, at.importance / probability};
      return;
    }
    hwy::Prefetch(&tree_.nodes()[tree_.left(at.node)]);
    hwy::Prefetch(&tree_.nodes()[tree_.right(at.node)]);
    descents_[count_++] = at;
  }

  // All one level down.
  void step() {
    const LightNode* children[2 * kSideBySide];
    for (size_t i = 0; i < count_; ++i) {
      children[2 * i] = &tree_.nodes()[tree_.left(descents_[i].node)];
      children[2 * i + 1] = &tree_.nodes()[tree_.right(descents_[i].node)];
    }
    float values[2 * kSideBySide];
    importance_.evaluate({children, 2 * count_}, values);
    const size_t count = count_;
    count_ = 0;
    for (size_t i = 0; i < count; ++i) {
      Descent at = descents_[i];
      const double a = double{values[2 * i]}, b = double{values[2 * i + 1]};
      if (!(a + b > 0)) continue;
      const double share = a / (a + b);
      // Without branches, which nobody could foretell.
      const bool second = !(at.u < share);
      const double chosen = second ? 1 - share : share;
      at.u = std::min((at.u - (second ? share : 0)) / chosen, 0x1.fffffffffffffp-1);
      at.probability *= chosen;
      at.importance = values[2 * i + second];
      const uint32_t left = tree_.left(at.node), right = tree_.right(at.node);
      at.node = second ? right : left;
      keep(at);
    }
  }

  const LightTree& tree_;
  const std::span<const Entry> entries_;
  const std::span<const g::DominantLights::Leaf> dominant_;
  const uint64_t seed_;
  Importance& importance_;
  std::vector<g::CutLight>& drawn_;
  Descent descents_[kSideBySide];
  size_t count_ = 0, next_ = 0;
};

// What all entries of a cut contribute.
float sumOf(std::span<const Entry> cut) {
  float sum = 0;
  for (const Entry& entry : cut) sum += entry.importance;
  return sum;
}

// Of the leaves, sorted, those that give at least so much by their own lobes; at most so many, the
// strongest. Appends their lights.
size_t keepDominant(const g::CutReceivers& receivers, std::span<const LightTree> trees,
                    std::span<const g::DominantLights::Leaf> leaves, float scale, float least,
                    size_t most, g::CutScratch* scratch, std::vector<g::CutLight>* lights) {
  scratch->dominant.clear();
  if (leaves.empty()) return 0;
  std::vector<g::CutScratch::Dominant>& kept = scratch->strongest;
  kept.clear();
  Importance exact(receivers, g::kStrip, 0, scale);
  constexpr size_t kAtOnce = 16;
  for (size_t begin = 0; begin < leaves.size(); begin += kAtOnce) {
    const size_t count = std::min(kAtOnce, leaves.size() - begin);
    const LightNode* nodes[kAtOnce];
    float values[kAtOnce];
    for (size_t i = 0; i < count; ++i)
      nodes[i] = &trees[leaves[begin + i].tree].nodes()[leaves[begin + i].node];
    exact.evaluate({nodes, count}, values);
    for (size_t i = 0; i < count; ++i)
      if (values[i] >= least) kept.push_back({leaves[begin + i], values[i]});
  }
  if (kept.size() > most) {
    const auto end = kept.begin() + static_cast<ptrdiff_t>(most);
    std::nth_element(kept.begin(), end, kept.end(), [](const auto& a, const auto& b) {
      return a.value != b.value ? a.value > b.value : a.leaf < b.leaf;
    });
    kept.resize(most);
    std::sort(kept.begin(), kept.end(),
              [](const auto& a, const auto& b) { return a.leaf < b.leaf; });
  }
  for (const g::CutScratch::Dominant& light : kept) {
    const LightTree& tree = trees[light.leaf.tree];
    scratch->dominant.push_back(light.leaf);
    lights->push_back({tree.light(tree.nodes()[light.leaf.node].link), 1, light.value});
  }
  return exact.evaluations();
}

size_t drawCutLights(const g::CutReceivers& receivers, int representatives,
                     std::span<const LightTree> trees,
                     std::span<const g::DominantLights::Leaf> dominant,
                     const g::CutSettings& settings, uint64_t seed, g::CutScratch* scratch,
                     std::vector<g::CutLight>* lights) {
  lights->clear();
  Importance importance(receivers, representatives, trees, settings.floor);
  const bool met = CutGrowth(trees, &importance, scratch).run(settings.nodes, settings.error);
  scratch->missed = settings.error > 0 && !met;
  std::vector<Entry>& cut = scratch->done;
  const float least = g::kDominant * sumOf(cut);
  const size_t compared = keepDominant(receivers, trees, dominant, importance.scale(), least,
                                       settings.nodes, scratch, lights);
  scratch->byNode.run(&cut,
                      [](const Entry& entry) { return uint64_t{entry.tree} << 32 | entry.node; });
  for (size_t begin = 0, end; begin < cut.size(); begin = end) {
    for (end = begin; end < cut.size() && cut[end].tree == cut[begin].tree;) ++end;
    Descents(trees[cut[begin].tree], std::span(cut).subspan(begin, end - begin), seed,
             scratch->dominant, &importance, &scratch->drawn)
        .run(lights);
  }
  float all = 0;
  for (const g::CutLight& light : *lights) all += light.share;
  for (g::CutLight& light : *lights) light.share /= all;
  return importance.evaluations() + compared;
}

void estimateNodes(const g::CutReceivers& receivers, int representatives, float floor,
                   std::span<const LightNode* const> nodes, float* values) {
  Importance(receivers, representatives, floor, 1).evaluate(nodes, values);
}

float estimateAll(const g::CutReceivers& receivers, int representatives,
                  std::span<const LightTree> trees, const g::CutSettings& settings, size_t nodes,
                  g::CutScratch* scratch, uint64_t* evaluations) {
  Importance importance(receivers, representatives, trees, settings.floor);
  CutGrowth(trees, &importance, scratch).run(nodes);
  *evaluations += importance.evaluations();
  return sumOf(scratch->done) / importance.scale();
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(drawCutLights);
HWY_EXPORT(estimateAll);
HWY_EXPORT(estimateNodes);
}  // namespace lobelia

namespace lobelia::gather {

size_t drawCutLights(const CutReceivers& receivers, int representatives,
                     std::span<const trees::LightTree> trees,
                     std::span<const DominantLights::Leaf> dominant, const CutSettings& settings,
                     uint64_t seed, CutScratch* scratch, std::vector<CutLight>* lights) {
  return HWY_DYNAMIC_DISPATCH(lobelia::drawCutLights)(receivers, representatives, trees, dominant,
                                                      settings, seed, scratch, lights);
}

void estimateNodes(const CutReceivers& receivers, int representatives, float floor,
                   std::span<const trees::LightNode* const> nodes, float* values) {
  HWY_DYNAMIC_DISPATCH(lobelia::estimateNodes)(receivers, representatives, floor, nodes, values);
}

float estimateAll(const CutReceivers& receivers, int representatives,
                  std::span<const trees::LightTree> trees, const CutSettings& settings,
                  size_t nodes, CutScratch* scratch, uint64_t* evaluations) {
  return HWY_DYNAMIC_DISPATCH(lobelia::estimateAll)(receivers, representatives, trees, settings,
                                                    nodes, scratch, evaluations);
}

}  // namespace lobelia::gather
#endif
