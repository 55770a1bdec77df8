#include "lobelia/relight/light_cut.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

namespace lobelia::relight {
namespace {

// Of what the cut's error is measured: negative powers (a broken map) count like positive ones.
double powerOf(const LightSums& sums, size_t node) {
  const double power = static_cast<double>(luminance(sums.power(node)));
  return std::isfinite(power) ? std::abs(power) : 0;
}

// Sum of squared differences of the leaves from their mean, by heap index, from the children's
// [methods: of two groups with sums a, b of n leaves each, it grows by (a - b)^2 / 2n].
std::vector<double> nodeErrors(const LightSums& sums) {
  const size_t leaves = size_t{1} << sums.levels;
  std::vector<double> errors(2 * leaves, 0.0), power(2 * leaves);
  for (size_t i = leaves; i < 2 * leaves; ++i) power[i] = powerOf(sums, i);
  size_t below = 1;  // leaves under each child
  for (size_t row = leaves / 2; row > 0; row /= 2, below *= 2)
    for (size_t i = row; i < 2 * row; ++i) {
      const double a = power[2 * i], b = power[2 * i + 1];
      power[i] = a + b;
      errors[i] =
          errors[2 * i] + errors[2 * i + 1] + (a - b) * (a - b) / (2 * static_cast<double>(below));
    }
  return errors;
}

struct Candidate {
  double value;
  size_t node;
  bool operator<(const Candidate& o) const {  // of equal ones the first in the tree
    return value != o.value ? value < o.value : node > o.node;
  }
};

class Refinement {
 public:
  Refinement(const LightSums& sums, size_t most)
      : leaves_(size_t{1} << sums.levels), most_(most), cut_{1} {}

  // Refines the node with the largest value until the cut is full or no value is above the least.
  template <class Value>
  void refine(size_t most, double least, const Value& value) {
    std::priority_queue<Candidate> queue;
    std::vector<size_t> done;
    const auto offer = [&](size_t node) {
      const double v = node < leaves_ ? value(node) : 0;
      if (v > least)
        queue.push({v, node});
      else
        done.push_back(node);
    };
    for (const size_t node : cut_) offer(node);
    size_t count = cut_.size();
    while (!queue.empty() && count < std::min(most, most_)) {
      const size_t node = queue.top().node;
      queue.pop();
      offer(2 * node), offer(2 * node + 1);
      ++count;
    }
    for (; !queue.empty(); queue.pop()) done.push_back(queue.top().node);
    cut_ = std::move(done);
  }
  // Heap indices, in no order.
  const std::vector<size_t>& nodes() const { return cut_; }

 private:
  size_t leaves_, most_;
  std::vector<size_t> cut_;
};

int depthOf(size_t node) { return static_cast<int>(std::bit_width(node)) - 1; }

}  // namespace

void makeLightCut(const LightSums& sums, std::vector<size_t>* nodes, LightCut* out) {
  const auto level = [&](size_t node) { return sums.levels - depthOf(node); };
  const auto firstLeaf = [&](size_t node) {
    return (node - (size_t{1} << depthOf(node))) << level(node);
  };
  std::sort(nodes->begin(), nodes->end(),
            [&](size_t a, size_t b) { return firstLeaf(a) < firstLeaf(b); });
  LightCut& cut = *out;
  cut.count = nodes->size();
  cut.nodes.clear(), cut.heap.clear(), cut.begin.clear();
  const size_t padded = (nodes->size() + kChunk - 1) / kChunk * kChunk;
  for (AlignedFloats* values : {&cut.r, &cut.g, &cut.b, &cut.x, &cut.y})
    values->assign(padded, 0.f);
  cut.z.assign(padded, 1.f);
  const size_t leaves = size_t{1} << sums.levels;
  cut.atLeaf.resize(leaves + 1);
  for (size_t i = 0; i < nodes->size(); ++i) {
    const size_t node = (*nodes)[i], first = firstLeaf(node);
    cut.nodes.push_back({static_cast<uint8_t>(level(node)), 0});
    cut.heap.push_back(static_cast<uint32_t>(node));
    cut.begin.push_back(static_cast<uint32_t>(first));
    std::fill_n(cut.atLeaf.begin() + static_cast<std::ptrdiff_t>(first), size_t{1} << level(node),
                static_cast<uint32_t>(i));
    const Rgb power = sums.power(node);
    cut.r[i] = power.x, cut.g[i] = power.y, cut.b[i] = power.z;
    cut.x[i] = sums.x[node], cut.y[i] = sums.y[node], cut.z[i] = sums.z[node];
  }
  cut.begin.push_back(static_cast<uint32_t>(leaves));
  cut.atLeaf[leaves] = static_cast<uint32_t>(nodes->size());
}

LightCut selectLightCut(const LightSums& sums, const LightCutSettings& settings) {
  const std::vector<double> errors = nodeErrors(sums);
  const double all = powerOf(sums, 1);
  Refinement cut(sums, std::max<size_t>(settings.nodeCount, 1));
  cut.refine(std::max<size_t>(settings.nodeCount / 2, 1), settings.errorShare * all,
             [&](size_t node) { return std::sqrt(errors[node]); });
  cut.refine(settings.nodeCount, 0, [&](size_t node) { return powerOf(sums, node); });
  std::vector<size_t> nodes = cut.nodes();
  LightCut out;
  makeLightCut(sums, &nodes, &out);
  return out;
}

}  // namespace lobelia::relight
