#include "lobelia/relight/median_clusters.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "lobelia/base/parallel.h"

namespace lobelia::relight {
namespace {

constexpr int kIterations = 4;    // of 2-means, each node
constexpr size_t kBlock = 1024;   // items that one thread takes, and sums of which are kept apart
constexpr size_t kRowBlock = 16;  // numbers that a loop over rows takes at once

// Means of a set of items, or a line through feature space.
struct Point {
  std::array<double, 6> place{};  // p, n
  std::vector<float> row;
};

class Splitter {
 public:
  explicit Splitter(const Features& features) : f_(features) {}

  // Halves order[begin, end).
  void split(std::span<uint32_t> items) const {
    std::vector<std::pair<float, uint32_t>> keyed(items.size());
    // Two ends of the cluster, far apart, are as good as any to begin with.
    const uint32_t a = farthest(items, mean(items)), b = farthest(items, itself(a));
    Point first = itself(a), second = itself(b);
    const auto middle = static_cast<std::ptrdiff_t>(items.size() / 2);
    for (int i = 0;; ++i) {
      const Point line = difference(second, first);
      forBlocks(items.size(), [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) keyed[k] = {along(line, items[k]), items[k]};
      });
      std::nth_element(keyed.begin(), keyed.begin() + middle, keyed.end());
      for (size_t k = 0; k < items.size(); ++k) items[k] = keyed[k].second;
      if (i + 1 == kIterations || items.size() <= 2) break;
      first = mean(items.first(items.size() / 2)), second = mean(items.subspan(items.size() / 2));
    }
  }

 private:
  // Blocks do not depend on threads; few items are not worth telling others.
  template <class F>
  static void forBlocks(size_t count, const F& f) {
    if (count <= kBlock) {
      f(0, count);
    } else {
      parallelRanges(count, kBlock, f);
    }
  }

  const uint8_t* row(uint32_t item) const { return f_.rows.data() + item * f_.rowLength; }

  Point itself(uint32_t item) const { return mean({&item, 1}); }

  Point mean(std::span<const uint32_t> items) const {
    const size_t blocks = (items.size() + kBlock - 1) / kBlock;
    std::vector<std::array<double, 6>> places(blocks);
    std::vector<uint32_t> rows(blocks * f_.rowLength);
    forBlocks(items.size(), [&](size_t begin, size_t end) {
      std::array<double, 6>& place = places[begin / kBlock];
      uint32_t* const sums = rows.data() + begin / kBlock * f_.rowLength;
      for (size_t k = begin; k < end; ++k) {
        for (size_t c = 0; c < 3; ++c) {
          place[c] += double{f_.p[items[k]][static_cast<int>(c)]};
          if (!f_.n.empty()) place[3 + c] += double{f_.n[items[k]][static_cast<int>(c)]};
        }
        const uint8_t* const values = row(items[k]);
        for (size_t c = 0; c < f_.rowLength; ++c) sums[c] += values[c];
      }
    });
    Point out;
    out.row.assign(f_.rowLength, 0);
    const double scale = 1 / static_cast<double>(items.size());
    for (size_t b = 0; b < blocks; ++b) {
      for (size_t c = 0; c < 6; ++c) out.place[c] += places[b][c] * scale;
      for (size_t c = 0; c < f_.rowLength; ++c)
        out.row[c] += static_cast<float>(rows[b * f_.rowLength + c]);
    }
    for (float& value : out.row) value *= static_cast<float>(scale);
    return out;
  }

  // Weighted, so that along() needs no weights.
  Point difference(const Point& to, const Point& from) const {
    Point out = to;
    for (size_t c = 0; c < 6; ++c)
      out.place[c] =
          (to.place[c] - from.place[c]) * double{c < 3 ? f_.placeWeight : f_.normalWeight};
    for (size_t c = 0; c < f_.rowLength; ++c) out.row[c] = (to.row[c] - from.row[c]) * f_.rowWeight;
    return out;
  }

  float along(const Point& line, uint32_t item) const {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
      sum += line.place[c] * double{f_.p[item][static_cast<int>(c)]};
      if (!f_.n.empty()) sum += line.place[3 + c] * double{f_.n[item][static_cast<int>(c)]};
    }
    return static_cast<float>(sum + double{dotRow(line.row.data(), row(item))});
  }

  float dotRow(const float* a, const uint8_t* b) const {
    float sums[kRowBlock] = {};
    size_t c = 0;
    for (; c + kRowBlock <= f_.rowLength; c += kRowBlock)
      for (size_t k = 0; k < kRowBlock; ++k) sums[k] += a[c + k] * static_cast<float>(b[c + k]);
    for (; c < f_.rowLength; ++c) sums[0] += a[c] * static_cast<float>(b[c]);
    return std::accumulate(sums, sums + kRowBlock, 0.f);
  }

  uint32_t farthest(std::span<const uint32_t> items, const Point& from) const {
    std::vector<float> distances(items.size());
    forBlocks(items.size(), [&](size_t begin, size_t end) {
      for (size_t k = begin; k < end; ++k) distances[k] = distance(from, items[k]);
    });
    const auto most = std::max_element(distances.begin(), distances.end());
    return items[static_cast<size_t>(most - distances.begin())];
  }

  float distance(const Point& from, uint32_t item) const {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double d = double{f_.p[item][static_cast<int>(c)]} - from.place[c];
      sum += double{f_.placeWeight} * d * d;
      if (f_.n.empty()) continue;
      const double e = double{f_.n[item][static_cast<int>(c)]} - from.place[3 + c];
      sum += double{f_.normalWeight} * e * e;
    }
    const uint8_t* const values = row(item);
    float sums[kRowBlock] = {};
    for (size_t c = 0; c < f_.rowLength; ++c)
      sums[c % kRowBlock] += sqr(static_cast<float>(values[c]) - from.row[c]);
    return static_cast<float>(sum + double{f_.rowWeight} *
                                        double{std::accumulate(sums, sums + kRowBlock, 0.f)});
  }

  const Features& f_;
};

}  // namespace

std::vector<size_t> clusterBegins(size_t count, int levels) {
  std::vector<size_t> begin{0, count};
  for (int level = 0; level < levels; ++level) {
    std::vector<size_t> halves;
    for (size_t i = 0; i + 1 < begin.size(); ++i) {
      halves.push_back(begin[i]);
      halves.push_back(begin[i] + (begin[i + 1] - begin[i]) / 2);
    }
    halves.push_back(count);
    begin = std::move(halves);
  }
  return begin;
}

std::vector<uint32_t> clusterOrder(const Features& features, int levels) {
  const size_t count = features.p.size();
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const Splitter splitter(features);
  for (int level = 0; level < levels; ++level) {
    const std::vector<size_t> begin = clusterBegins(count, level);
    parallelFor(begin.size() - 1, 1, [&](size_t i) {
      const std::span<uint32_t> items(order.data() + begin[i], begin[i + 1] - begin[i]);
      if (items.size() > 1) splitter.split(items);
    });
  }
  return order;
}

}  // namespace lobelia::relight
