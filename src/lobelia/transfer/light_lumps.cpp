#include "lobelia/transfer/light_lumps.h"

#include <algorithm>
#include <cmath>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::transfer {
namespace {

struct Lump {
  Vec3d power{}, moment{};
  double weight = 0;
  int count = 0;
  void add(const relight::DirectedPower& p) {
    const auto size = static_cast<double>(std::abs(luminance(p.power)));
    const auto wide = [](Vec3f v) {
      return Vec3d(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
    };
    power += wide(p.power);
    moment += wide(p.direction) * size;
    weight += size;
    ++count;
  }
};

void append(const Lump& lump, double kappa, LumpLobes* out) {
  const double size = length(lump.moment);
  if (size <= 0) return;  // black
  double sharp = kappa;
  if (lump.count > 1)
    sharp = std::min(kappa, lobes::inverseMeanResultant(lobes::meanResultant(kappa) *
                                                        std::min(1.0, size / lump.weight)));
  const Vec3d axis = lump.moment / size;
  const Vec3d value = lump.power / static_cast<double>(lobes::integral(static_cast<float>(sharp)));
  const auto put = [](std::vector<float>& values, double v) {
    values.push_back(static_cast<float>(v));
  };
  put(out->x, axis.x), put(out->y, axis.y), put(out->z, axis.z);
  put(out->halfKappa, sharp / 2);
  put(out->r, value.x), put(out->g, value.y), put(out->b, value.z);
}

float thetaOf(Vec3f d) { return std::acos(std::clamp(d.z, -1.f, 1.f)); }

// Half of the angle about +z over which a parallel at `theta` lies in a cone of half angle `radius`
// about an axis at `axisTheta`; kPi: all of it.
float halfWidthAt(float theta, float axisTheta, float radius) {
  const float sines = std::sin(theta) * std::sin(axisTheta);
  const float rest = std::cos(radius) - std::cos(theta) * std::cos(axisTheta);
  if (rest >= sines) return 0;
  return rest <= -sines ? kPi : std::acos(rest / sines);
}

}  // namespace

LightLumps::LightLumps(std::span<const relight::DirectedPower> powers, float kappa, float width) {
  const auto rows = static_cast<size_t>(std::ceil(kPi / width));
  rowBegin_.push_back(0);
  for (size_t row = 0; row < rows; ++row) {
    const float theta = (static_cast<float>(row) + 0.5f) * kPi / static_cast<float>(rows);
    const float columns = std::ceil(kTwoPi * std::sin(theta) / width);
    rowBegin_.push_back(rowBegin_.back() + static_cast<uint32_t>(columns));
  }
  // Sorted by cell, in the order of the powers within it.
  std::vector<uint32_t> cells(powers.size()), order(powers.size());
  cellBegin_.assign(rowBegin_.back() + size_t{1}, 0);
  for (size_t i = 0; i < powers.size(); ++i) {
    cells[i] = cellOf(powers[i].direction);
    ++cellBegin_[cells[i]];
  }
  uint32_t begin = 0;
  for (uint32_t& count : cellBegin_) begin += std::exchange(count, begin);
  for (size_t i = 0; i < powers.size(); ++i)
    order[cellBegin_[cells[i]]++] = static_cast<uint32_t>(i);
  size_t next = 0;
  for (size_t cell = 0; cell < cellBegin_.size(); ++cell) {
    const size_t end = cellBegin_[cell];  // where the cell's powers end, by now
    cellBegin_[cell] = static_cast<uint32_t>(lobes_.count());
    Lump lump;
    for (; next < end; ++next) lump.add(powers[order[next]]);
    append(lump, static_cast<double>(kappa), &lobes_);
  }
}

size_t LightLumps::rowOf(float theta) const {
  const auto rows = static_cast<float>(rowBegin_.size() - 1);
  return static_cast<size_t>(std::clamp(theta * rows * kInvPi, 0.f, rows - 1));
}

uint32_t LightLumps::cellOf(Vec3f d) const {
  const size_t row = rowOf(thetaOf(d));
  const uint32_t columns = rowBegin_[row + 1] - rowBegin_[row];
  const float at = (std::atan2(d.y, d.x) / kTwoPi + 0.5f) * static_cast<float>(columns);
  return rowBegin_[row] + std::min(static_cast<uint32_t>(at), columns - 1);
}

void LightLumps::findInRow(size_t row, float phi, float halfWidth,
                           std::vector<std::pair<uint32_t, uint32_t>>* ranges) const {
  const uint32_t first = rowBegin_[row];
  const auto columns = static_cast<int>(rowBegin_[row + 1] - first);
  const auto append = [&](int from, int to) {
    const uint32_t begin = cellBegin_[first + static_cast<uint32_t>(from)];
    const uint32_t end = cellBegin_[first + static_cast<uint32_t>(to)];
    if (begin < end) ranges->emplace_back(begin, end);
  };
  const float perRadian = static_cast<float>(columns) / kTwoPi;
  const int from = static_cast<int>(std::floor((phi + kPi - halfWidth) * perRadian));
  const int to = static_cast<int>(std::floor((phi + kPi + halfWidth) * perRadian)) + 1;
  if (to - from >= columns) {
    append(0, columns);
  } else if (from < 0) {
    append(0, to);
    append(from + columns, columns);
  } else if (to > columns) {
    append(0, to - columns);
    append(from, columns);
  } else {
    append(from, to);
  }
}

void LightLumps::find(Vec3f axis, float radius,
                      std::vector<std::pair<uint32_t, uint32_t>>* ranges) const {
  const size_t rows = rowBegin_.size() - 1;
  const float height = kPi / static_cast<float>(rows);
  const float theta = thetaOf(axis), phi = std::atan2(axis.y, axis.x);
  if (radius >= kPi) {
    if (lobes_.count() > 0) ranges->emplace_back(0, static_cast<uint32_t>(lobes_.count()));
    return;
  }
  // The parallel at which the cone is widest, where it does not hold a pole.
  const bool holdsPole = theta <= radius || theta >= kPi - radius;
  const float widest = holdsPole ? theta : std::acos(std::cos(theta) / std::cos(radius));
  for (size_t row = rowOf(theta - radius); row <= rowOf(theta + radius); ++row) {
    const float top = static_cast<float>(row) * height, bottom = top + height;
    float half = std::max(halfWidthAt(top, theta, radius), halfWidthAt(bottom, theta, radius));
    if (widest > top && widest < bottom) half = std::max(half, halfWidthAt(widest, theta, radius));
    if (theta > top && theta < bottom) half = std::max(half, halfWidthAt(theta, theta, radius));
    if (holdsPole && (row == 0 || row + 1 == rows)) half = kPi;
    // A hair more, for directions on the edge of a cell.
    findInRow(row, phi, std::min(half * 1.0001f + 1e-6f, kPi), ranges);
  }
}

}  // namespace lobelia::transfer
