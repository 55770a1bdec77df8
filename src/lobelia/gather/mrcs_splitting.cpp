// Splitting phase of the clustering; the head of mrcs_clusters.h says what for.
#include <algorithm>
#include <cmath>
#include <queue>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/mrcs_sampling.h"

namespace lobelia::gather {
namespace {

constexpr size_t kAtOnce = 8;  // clusters that are split in parallel

// Vectors are unpacked again whenever they are needed: clusters can be large.
class Splitter {
 public:
  Splitter(const LightColumns& columns, std::span<uint32_t> lights, uint64_t seed)
      : columns_(columns),
        lights_(lights),
        seed_(seed),
        dims_(columns.dims),
        vector_(columns.stride()),
        line_(dims_) {}

  // Sorts the lights along a line; returns how many belong to the first half, at least 1.
  size_t split() {
    sortAlongLine();
    return cheapestCut();
  }

 private:
  const float* load(size_t i) {
    columns_.load(lights_[i], vector_.data());
    return vector_.data();
  }
  AlignedFloats copy(size_t i) {
    const float* v = load(i);
    return AlignedFloats(v, v + dims_);
  }
  double weight(size_t i) const { return double{columns_.weight[lights_[i]]}; }
  double unseen(size_t i) const { return columns_.unseenOf(lights_[i]); }
  double dot(const float* a, const float* b) const { return double{dotProduct(a, b, dims_)}; }

  // Index drawn in proportion to f.
  template <class F>
  size_t draw(uint64_t index, const F& f) const {
    double total = 0;
    for (size_t i = 0; i < lights_.size(); ++i) total += f(i);
    double left = uniformNumber(seed_, index) * total;
    size_t last = 0;
    for (size_t i = 0; i < lights_.size(); ++i) {
      if (!(f(i) > 0)) continue;
      last = i;
      if ((left -= f(i)) < 0) break;
    }
    return last;
  }

  void sortAlongLine() {
    const size_t n = lights_.size();
    const size_t a = draw(0, [&](size_t i) { return weight(i); });
    const AlignedFloats from = copy(a);
    std::vector<double> distance(n);
    for (size_t i = 0; i < n; ++i) {
      const float* v = load(i);
      for (size_t d = 0; d < dims_; ++d) line_[d] = v[d] - from[d];
      distance[i] = weight(i) * (dot(line_.data(), line_.data()) + unseen(i) + unseen(a));
    }
    distance[a] = 0;
    const size_t b = draw(1, [&](size_t i) { return distance[i]; });
    const AlignedFloats to = copy(b);
    for (size_t d = 0; d < dims_; ++d) line_[d] = to[d] - from[d];
    std::vector<std::pair<double, uint32_t>> places(n);  // ties by the light's number
    for (size_t i = 0; i < n; ++i) {
      double place = dot(load(i), line_.data());
      if (i == b) place += unseen(b);
      if (i == a) place -= unseen(a);
      places[i] = {place, lights_[i]};
    }
    std::sort(places.begin(), places.end());
    for (size_t i = 0; i < n; ++i) lights_[i] = places[i].second;
  }

  // Costs of both sides by running sums: over the lights before the cut, and totals less those.
  size_t cheapestCut() {
    const size_t n = lights_.size();
    AlignedFloats total(dims_, 0.f), sum(dims_, 0.f);
    double weights = 0, squares = 0;
    for (size_t k = 0; k < n; ++k) {
      const float* v = load(k);
      addScaled(static_cast<float>(weight(k)), v, dims_, total.data());
      weights += weight(k);
      squares += weight(k) * (dot(v, v) + unseen(k));
    }
    const double totalSquared = dot(total.data(), total.data());
    double w = 0, q = 0, sumSquared = 0, sumTotal = 0, least = 0;
    size_t best = 0;
    for (size_t k = 0; k + 1 < n; ++k) {
      const float* v = load(k);
      const double wk = weight(k), squared = dot(v, v);
      sumSquared += wk * (2 * dot(v, sum.data()) + wk * squared);
      sumTotal += wk * dot(v, total.data());
      addScaled(static_cast<float>(wk), v, dims_, sum.data());
      w += wk;
      q += wk * (squared + unseen(k));
      // Less the unseen parts of the sums, which are the same for every cut.
      const double cost = w * q - sumSquared + (weights - w) * (squares - q) -
                          (totalSquared - 2 * sumTotal + sumSquared);
      if (best != 0 && !(cost < least)) continue;
      best = k + 1;
      least = cost;
    }
    return best;
  }

  const LightColumns& columns_;
  std::span<uint32_t> lights_;  // sorted along the line in the end
  const uint64_t seed_;
  const size_t dims_;
  AlignedFloats vector_, line_;
};

struct Expensive {
  double cost;
  size_t cluster;
  // Ties by number, so that the order does not depend on the heap's history.
  bool operator<(const Expensive& o) const {
    return cost != o.cost ? cost < o.cost : cluster > o.cluster;
  }
};

}  // namespace

void splitClusters(const LightColumns& columns, size_t count, double errorLimit, uint64_t seed,
                   Clustering* clustering, Context& context) {
  std::vector<LightCluster>& clusters = clustering->clusters;
  std::priority_queue<Expensive> heap;
  const auto push = [&](size_t k) {
    if (clusters[k].size() > 1 && clusters[k].cost > 0) heap.push({clusters[k].cost, k});
  };
  for (size_t k = 0; k < clusters.size(); ++k) push(k);
  while (clusters.size() < count && !heap.empty() && !context.cancelled()) {
    if (errorLimit > 0 && clustering->checkError(columns) <= errorLimit) return;
    std::vector<size_t> chosen;
    while (chosen.size() < std::min(kAtOnce, count - clusters.size()) && !heap.empty()) {
      chosen.push_back(heap.top().cluster);
      heap.pop();
    }
    std::vector<std::pair<LightCluster, LightCluster>> halves(chosen.size());
    parallelFor(chosen.size(), 1, [&](size_t i) {
      const LightCluster& whole = clusters[chosen[i]];
      const std::span<uint32_t> lights =
          std::span(clustering->order).subspan(whole.begin, whole.size());
      // A cluster is known by its beginning and end.
      const uint64_t own = hashCombine(seed, whole.begin * columns.count + whole.end);
      const size_t cut = Splitter(columns, lights, own).split();
      const std::vector<uint32_t>& order = clustering->order;
      halves[i].first = measureCluster(columns, order, whole.begin, whole.begin + cut);
      halves[i].second = measureCluster(columns, order, whole.begin + cut, whole.end);
    });
    for (size_t i = 0; i < chosen.size(); ++i) {
      const auto& [first, second] = halves[i];
      const LightCluster& whole = clusters[chosen[i]];
      clustering->cost += first.cost + second.cost - whole.cost;
      clustering->rowCost += first.rowCost + second.rowCost - whole.rowCost;
      clustering->checkCost += first.checkCost + second.checkCost - whole.checkCost;
      clusters[chosen[i]] = first;
      clusters.push_back(second);
      push(chosen[i]);
      push(clusters.size() - 1);
    }
    context.progress("cluster", static_cast<double>(clusters.size()) / static_cast<double>(count));
  }
}

}  // namespace lobelia::gather
