#include "lobelia/gather/receiver_clusters.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace lobelia::gather {
namespace {

// A difference of normals of 1 counts as much as this share of the scene's size, or, unless it is
// that of an edge, as the points' extent where that is less.
constexpr float kNormalShare = 0.05f;
constexpr float kTurned = 0.9f;
// Pixels of a compact cluster lie in a square of this side, those of others in one twice as wide.
constexpr uint32_t kCompactSide = 32;
// More take time in proportion and leave no less error.
constexpr int kMostRepresentatives = 4;
// And its points lie within this share of the scene's size, and their normals agree.
constexpr float kCompactShare = 0.02f;
constexpr float kCompactCosine = 0.7f;

class Clusters {
 public:
  Clusters(const Receivers& receivers, float scale, int width, ReceiverClusters* out)
      : points_(receivers.points),
        inverseScale_(1 / std::max(kNormalShare * scale, 1e-30f)),
        width_(static_cast<uint32_t>(width)),
        out_(*out) {}

  // Cuts order[begin, end) in the middle of its widest extent until it fits, filling strips.
  void split(size_t begin, size_t end) {
    const size_t count = end - begin;
    const size_t strip = static_cast<size_t>(kStrip);
    const uint32_t side = count > strip ? 0 : sideOf(begin, end);
    if (count <= strip && (count == 1 || side <= 2 * kCompactSide)) return add(begin, end, side);
    int widest = 0;
    float extent = -1, places = 0;
    for (int dim = 0; dim < 6; ++dim) {
      float lo = 3.4e38f, hi = -3.4e38f;
      for (size_t i = begin; i < end; ++i) {
        const float x = coordinate(out_.order[i], dim);
        lo = std::min(lo, x), hi = std::max(hi, x);
      }
      float size = hi - lo;
      if (dim < 3)
        places = std::max(places, size);
      else if (size < kTurned)
        size *= std::min(1.f, places);
      if (size > extent) widest = dim, extent = size;
    }
    const size_t half = count > strip ? (count / 2 + strip - 1) / strip * strip : count / 2;
    const auto first = out_.order.begin() + static_cast<ptrdiff_t>(begin);
    std::nth_element(first, first + static_cast<ptrdiff_t>(half),
                     out_.order.begin() + static_cast<ptrdiff_t>(end), [&](uint32_t a, uint32_t b) {
                       const float x = coordinate(a, widest), y = coordinate(b, widest);
                       return x != y ? x < y : a < b;
                     });
    split(begin, begin + half);
    split(begin + half, end);
  }

 private:
  float coordinate(uint32_t point, int dim) const {
    const ReceiverPoint& p = points_[point];
    return dim < 3 ? p.p[dim] * inverseScale_ : p.frame.n[dim - 3];
  }

  uint32_t sideOf(size_t begin, size_t end) const {
    uint32_t x0 = ~0u, x1 = 0, y0 = ~0u, y1 = 0;
    for (size_t i = begin; i < end; ++i) {
      const uint32_t pixel = points_[out_.order[i]].pixel;
      x0 = std::min(x0, pixel % width_), x1 = std::max(x1, pixel % width_);
      y0 = std::min(y0, pixel / width_), y1 = std::max(y1, pixel / width_);
    }
    return std::max(x1 - x0, y1 - y0) + 1;
  }

  bool near(size_t begin, size_t end) const {
    Bounds3f bounds;
    const Vec3f n = points_[out_.order[begin]].frame.n;
    for (size_t i = begin; i < end; ++i) {
      const ReceiverPoint& point = points_[out_.order[i]];
      bounds.add(point.p);
      if (dot(point.frame.n, n) < kCompactCosine) return false;
    }
    return length(bounds.extent()) * inverseScale_ * kNormalShare < kCompactShare;
  }

  // In the order in which they were given, so that tiles do not depend on how they were cut.
  void add(size_t begin, size_t end, uint32_t side) {
    std::sort(out_.order.begin() + static_cast<ptrdiff_t>(begin),
              out_.order.begin() + static_cast<ptrdiff_t>(end));
    const int representatives = representativesOf(begin, end);
    out_.clusters.push_back({static_cast<uint32_t>(begin), static_cast<uint32_t>(end),
                             side <= kCompactSide && representatives == 1, representatives});
  }

  int representativesOf(size_t begin, size_t end) const {
    int count = 1;
    const auto runsAreNear = [&] {
      const size_t run = static_cast<size_t>(kStrip / count);
      for (size_t i = begin; i < end; i += run)
        if (!near(i, std::min(i + run, end))) return false;
      return true;
    };
    while (count < kMostRepresentatives && !runsAreNear()) count *= 2;
    return count;
  }

  const std::vector<ReceiverPoint>& points_;
  const float inverseScale_;
  const uint32_t width_;
  ReceiverClusters& out_;
};

}  // namespace

ReceiverClusters clusterReceivers(const Receivers& receivers, float scale, int width) {
  if (width < 1) throw std::invalid_argument("clusterReceivers: width");
  ReceiverClusters out;
  std::map<LobeKinds, std::vector<uint32_t>> kinds;
  for (size_t i = 0; i < receivers.points.size(); ++i)
    if (receivers.points[i].lobeCount > 0)
      kinds[kindsOf(receivers, receivers.points[i])].push_back(static_cast<uint32_t>(i));
  for (const auto& [kind, points] : kinds)
    out.order.insert(out.order.end(), points.begin(), points.end());
  Clusters clusters(receivers, scale, width, &out);
  size_t begin = 0;
  for (const auto& [kind, points] : kinds) {
    clusters.split(begin, begin + points.size());
    begin += points.size();
  }
  out.receivers.lobes = receivers.lobes;
  for (const uint32_t i : out.order) out.receivers.points.push_back(receivers.points[i]);
  return out;
}

}  // namespace lobelia::gather
