// The table is filled from a grid over space: the directions near a cell's centre lie in the boxes
// around it.
#include "lobelia/relight/direction_lookup.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"

namespace lobelia::relight {
namespace {

// Boxes of directions, about as wide as twice the distance between neighbours.
class BoxGrid {
 public:
  explicit BoxGrid(std::span<const Vec3f> directions) : directions_(directions) {
    const float spacing = std::sqrt(4 * kPi / static_cast<float>(directions.size()));
    side_ = std::clamp(static_cast<int>(1 / spacing), 1, 128);
    begin_.assign(static_cast<size_t>(side_ * side_ * side_) + 1, 0);
    for (const Vec3f d : directions) ++begin_[boxOf(d) + 1];
    for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    items_.resize(directions.size());
    std::vector<uint32_t> next = begin_;
    for (uint32_t i = 0; i < directions.size(); ++i) items_[next[boxOf(directions[i])]++] = i;
  }

  uint32_t nearest(Vec3f d) const {
    const Vec3<int> at{coordinate(d.x), coordinate(d.y), coordinate(d.z)};
    uint32_t best = 0;
    float closest = 8;
    // Whatever lies outside of the boxes within `reach` is at least reach boxes away.
    for (int reach = 1; reach <= 2 * side_; reach *= 2) {
      search(d, at, reach, &best, &closest);
      if (closest <= sqr(static_cast<float>(reach) * 2 / static_cast<float>(side_))) break;
    }
    return best;
  }

 private:
  void search(Vec3f d, Vec3<int> at, int reach, uint32_t* best, float* closest) const {
    const auto low = [&](int c) { return std::max(c - reach, 0); };
    const auto high = [&](int c) { return std::min(c + reach, side_ - 1); };
    for (int z = low(at.z); z <= high(at.z); ++z)
      for (int y = low(at.y); y <= high(at.y); ++y) {
        const size_t row = static_cast<size_t>((z * side_ + y) * side_);
        const uint32_t end = begin_[row + static_cast<size_t>(high(at.x)) + 1];
        for (uint32_t i = begin_[row + static_cast<size_t>(low(at.x))]; i < end; ++i) {
          const float distance = lengthSquared(directions_[items_[i]] - d);
          // Of several as near the first: no answer depends on the order of boxes.
          if (distance < *closest || (distance == *closest && items_[i] < *best))
            *closest = distance, *best = items_[i];
        }
      }
  }
  int coordinate(float x) const {
    return std::clamp(static_cast<int>((x + 1) * 0.5f * static_cast<float>(side_)), 0, side_ - 1);
  }
  size_t boxOf(Vec3f d) const {
    return static_cast<size_t>((coordinate(d.z) * side_ + coordinate(d.y)) * side_ +
                               coordinate(d.x));
  }

  std::span<const Vec3f> directions_;
  int side_;
  std::vector<uint32_t> begin_, items_;
};

}  // namespace

DirectionLookup::DirectionLookup(std::span<const Vec3f> directions) {
  const auto wanted = static_cast<int>(std::sqrt(static_cast<float>(directions.size()) * 2));
  side_ = std::clamp(wanted, 16, 256);
  cells_.resize(6 * static_cast<size_t>(side_) * static_cast<size_t>(side_));
  const BoxGrid grid(directions);
  parallelFor(cells_.size(), 1024, [&](size_t i) { cells_[i] = grid.nearest(centreOf(i)); });
}

// Faces in the order +x, -x, +y, -y, +z, -z; on a face the other two axes in their order.
size_t DirectionLookup::cellOf(Vec3f d) const {
  const Vec3f a{std::abs(d.x), std::abs(d.y), std::abs(d.z)};
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const float size = a[axis];
  const auto cell = [&](float x) {
    const float at = (x / size + 1) * 0.5f * static_cast<float>(side_);
    return static_cast<size_t>(std::clamp(static_cast<int>(at), 0, side_ - 1));
  };
  const size_t face = static_cast<size_t>(2 * axis + (d[axis] < 0 ? 1 : 0));
  const size_t side = static_cast<size_t>(side_);
  return (face * side + cell(d[axis == 2 ? 1 : 2])) * side + cell(d[axis == 0 ? 1 : 0]);
}

Vec3f DirectionLookup::centreOf(size_t i) const {
  const size_t side = static_cast<size_t>(side_);
  const auto at = [&](size_t cell) {
    return (2 * static_cast<float>(cell) + 1) / static_cast<float>(side_) - 1;
  };
  const int face = static_cast<int>(i / (side * side)), axis = face / 2;
  Vec3f d;
  d[axis] = face % 2 == 0 ? 1.f : -1.f;
  d[axis == 2 ? 1 : 2] = at(i / side % side);
  d[axis == 0 ? 1 : 0] = at(i % side);
  return normalize(d);
}

}  // namespace lobelia::relight
