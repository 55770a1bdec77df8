#include "lobelia/gather/receiver_slices.h"

#include <algorithm>
#include <queue>
#include <stdexcept>

#include "lobelia/base/random.h"

namespace lobelia::gather {
namespace {

// A difference of normals of 1 counts as much as this share of the scene's size, as in
// receiver_clusters.cpp.
constexpr float kNormalShare = 0.05f;

}  // namespace

// order_[begin, end), still whole.
struct ReceiverSlices::Cell {
  uint32_t node = 0;
  size_t begin = 0, end = 0;
  double spread = 0;
  Coordinates middle{};
  int widest = 0;
  bool operator<(const Cell& o) const {
    return spread != o.spread ? spread < o.spread : node > o.node;
  }
};

ReceiverSlices::Coordinates ReceiverSlices::coordinatesOf(const ReceiverPoint& point) const {
  const Vec3f p = point.p * inverseScale_, n = point.frame.n;
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

ReceiverSlices::Cell ReceiverSlices::measure(uint32_t node, size_t begin, size_t end) const {
  Cell cell;
  cell.node = node, cell.begin = begin, cell.end = end;
  float widest = -1;
  for (size_t dim = 0; dim < cell.middle.size(); ++dim) {
    double sum = 0, squares = 0;
    float lo = 3.4e38f, hi = -3.4e38f;
    for (size_t i = begin; i < end; ++i) {
      const float x = points_[order_[i]][dim];
      sum += double{x}, squares += double{x} * double{x};
      lo = std::min(lo, x), hi = std::max(hi, x);
    }
    const double mean = sum / static_cast<double>(end - begin);
    cell.middle[dim] = static_cast<float>(mean);
    cell.spread += std::max(squares - sum * mean, 0.0);
    if (hi - lo > widest) widest = hi - lo, cell.widest = static_cast<int>(dim);
  }
  return cell;
}

// Where the points are all alike there is nothing to cut.
bool ReceiverSlices::cut(const Cell& cell, size_t* middle, Node* plane) {
  const size_t dim = static_cast<size_t>(cell.widest);
  const auto begin = order_.begin() + static_cast<ptrdiff_t>(cell.begin);
  const auto end = order_.begin() + static_cast<ptrdiff_t>(cell.end);
  const auto at = [&](uint32_t i) { return points_[i][dim]; };
  std::sort(begin, end,
            [&](uint32_t a, uint32_t b) { return at(a) != at(b) ? at(a) < at(b) : a < b; });
  const auto half = begin + (end - begin) / 2;
  auto first = std::lower_bound(begin, half, at(*half),
                                [&](uint32_t i, float value) { return at(i) < value; });
  if (first == begin)
    first = std::upper_bound(half, end, at(*half),
                             [&](float value, uint32_t i) { return value < at(i); });
  if (first == end) return false;
  *middle = static_cast<size_t>(first - order_.begin());
  plane->dim = cell.widest;
  plane->value = at(*first);
  return true;
}

ReceiverSlices::ReceiverSlices(const Receivers& sample, size_t count, float scale, uint64_t seed)
    : inverseScale_(1 / std::max(kNormalShare * scale, 1e-30f)) {
  if (sample.points.empty() || count == 0)
    throw std::invalid_argument("ReceiverSlices: no receivers, or no slices");
  for (const ReceiverPoint& point : sample.points) {
    order_.push_back(static_cast<uint32_t>(order_.size()));
    points_.push_back(coordinatesOf(point));
  }
  nodes_.resize(1);
  std::priority_queue<Cell> cells;
  cells.push(measure(0, 0, order_.size()));
  while (cells.size() < count && cells.top().spread > 0) {
    Cell cell = cells.top();
    cells.pop();
    size_t middle = 0;
    Node plane;
    if (!cut(cell, &middle, &plane)) {  // its spread is rounding
      cell.spread = 0;
      cells.push(cell);
      continue;
    }
    plane.first = static_cast<uint32_t>(nodes_.size());
    nodes_[cell.node] = plane;
    nodes_.resize(nodes_.size() + 2);
    cells.push(measure(plane.first, cell.begin, middle));
    cells.push(measure(plane.first + 1, middle, cell.end));
  }
  for (; !cells.empty(); cells.pop()) {
    const Cell& cell = cells.top();
    const uint32_t slice = static_cast<uint32_t>(representatives_.size());
    nodes_[cell.node].first = slice;
    representatives_.push_back(
        order_[cell.begin + hashCombine(seed, slice) % (cell.end - cell.begin)]);
    middles_.push_back(cell.middle);
  }
}

uint32_t ReceiverSlices::sliceOf(const ReceiverPoint& point) const {
  const Coordinates at = coordinatesOf(point);
  const Node* node = nodes_.data();
  while (node->dim >= 0)
    node = &nodes_[node->first + (at[static_cast<size_t>(node->dim)] < node->value ? 0 : 1)];
  return node->first;
}

std::vector<ReceiverSlices::Neighbour> ReceiverSlices::neighbours(size_t slice, size_t most) const {
  std::vector<Neighbour> out;
  for (size_t s = 0; s < count(); ++s) {
    float sum = 0;
    for (size_t dim = 0; dim < middles_[s].size(); ++dim) {
      const float apart = middles_[s][dim] - middles_[slice][dim];
      sum += apart * apart;
    }
    // Another slice of the same middle comes behind.
    out.push_back({static_cast<uint32_t>(s), s == slice ? -1.f : sum});
  }
  most = std::min(most, out.size());
  std::partial_sort(out.begin(), out.begin() + static_cast<ptrdiff_t>(most), out.end(),
                    [](const Neighbour& a, const Neighbour& b) {
                      if (a.squaredDistance != b.squaredDistance)
                        return a.squaredDistance < b.squaredDistance;
                      return a.slice < b.slice;
                    });
  out.resize(most);
  out[0].squaredDistance = 0;
  return out;
}

}  // namespace lobelia::gather
