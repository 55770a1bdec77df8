#include "lobelia/relight/point_grid.h"

#include <algorithm>

namespace lobelia::relight {

PointGrid::PointGrid(std::span<const Vec3f> points, float radius)
    : points_(points), radius_(radius) {
  constexpr float kMostCells = 128;  // per axis
  Bounds3f box;
  for (const Vec3f p : points) box.add(p);
  if (points.empty()) box.add(Vec3f(0.f));
  const float least = maxComponent(box.extent()) / kMostCells;
  const float cell = std::max(radius, least);
  finest_ = radius <= least || least == 0;  // 0: one place
  origin_ = box.lo, inverseCell_ = 1 / cell;
  const Vec3f extent = box.extent() * inverseCell_;
  size_ = {static_cast<int>(extent.x) + 1, static_cast<int>(extent.y) + 1,
           static_cast<int>(extent.z) + 1};
  begin_.assign(index({0, 0, size_.z}) + 1, 0);
  std::vector<size_t> cells(points.size());
  for (size_t i = 0; i < points.size(); ++i) ++begin_[(cells[i] = index(cellOf(points[i]))) + 1];
  for (size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
  order_.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) order_[next[cells[i]]++] = static_cast<uint32_t>(i);
}

double PointGrid::meanCompany() const {
  double sum = 0;
  for (size_t c = 1; c < begin_.size(); ++c) {
    const double count = static_cast<double>(begin_[c] - begin_[c - 1]);
    sum += count * count;
  }
  return points_.empty() ? 0 : sum / static_cast<double>(points_.size());
}

float PointGrid::uncrowded(std::span<const Vec3f> points, float radius) {
  constexpr double kCrowd = 64;  // even samples of a surface have 2 to 12
  for (;; radius *= 0.7f) {
    const PointGrid grid(points, radius);
    if (grid.finest_ || grid.meanCompany() <= kCrowd) return radius;
  }
}

PointGrid::Cell PointGrid::cellOf(Vec3f p) const {
  const Vec3f at = (p - origin_) * inverseCell_;
  const auto clamped = [](float v, int size) {
    return static_cast<int>(std::clamp(v, 0.f, static_cast<float>(size - 1)));
  };
  return {clamped(at.x, size_.x), clamped(at.y, size_.y), clamped(at.z, size_.z)};
}

}  // namespace lobelia::relight
