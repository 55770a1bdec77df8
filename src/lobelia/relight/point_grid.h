// Points in space sorted into cubic cells, to find those near a place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::relight {

class PointGrid {
 public:
  // radius: how far near() can see, > 0.
  PointGrid(std::span<const Vec3f> points, float radius);
  // The radius, or less of it where so many points crowd into cells (foliage, stacked sheets) that
  // nearly all are near to each other: as much as leaves some 64 in a cell, seen from its points. A
  // crowd in a cell of the finest grid there is (1/128 of the box) remains.
  static float uncrowded(std::span<const Vec3f> points, float radius);

  // use(i) for every point within the radius of p, perhaps p itself, in an order that depends on
  // the points alone.
  template <class Use>
  void near(Vec3f p, const Use& use) const {
    const Vec3f least = p - Vec3f(radius_), most = p + Vec3f(radius_);
    const Cell lo = cellOf(least), hi = cellOf(most);
    for (int z = lo.z; z <= hi.z; ++z)
      for (int y = lo.y; y <= hi.y; ++y) {
        // Cells of a row follow one another.
        const size_t begin = begin_[index({lo.x, y, z})], end = begin_[index({hi.x, y, z}) + 1];
        for (size_t k = begin; k < end; ++k)
          if (lengthSquared(points_[order_[k]] - p) <= radius_ * radius_) use(order_[k]);
      }
  }

 private:
  struct Cell {
    int x, y, z;
  };
  Cell cellOf(Vec3f p) const;
  double meanCompany() const;  // points in a point's cell
  size_t index(Cell c) const {
    return (static_cast<size_t>(c.z) * static_cast<size_t>(size_.y) + static_cast<size_t>(c.y)) *
               static_cast<size_t>(size_.x) +
           static_cast<size_t>(c.x);
  }
  std::span<const Vec3f> points_;
  float radius_;
  bool finest_ = false;  // would a smaller radius make no smaller cells?
  Vec3f origin_;
  float inverseCell_ = 1;
  Cell size_{1, 1, 1};
  std::vector<uint32_t> order_;  // points by cell
  std::vector<size_t> begin_;    // of each cell, and the end
};

}  // namespace lobelia::relight
