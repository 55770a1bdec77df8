#include "lobelia/path/spherical_image.h"

namespace lobelia {

SphericalImage::Cell SphericalImage::cellAt(Vec2f s) const {
  const float x = s.x * static_cast<float>(width()), y = s.y * static_cast<float>(rows_);
  Cell cell{};
  cell.x0 = std::clamp(static_cast<int>(x), 0, width() - 1);
  cell.y0 = std::clamp(static_cast<int>(y), 0, rows_ - 1);
  cell.x1 = cell.x0 + 1 == width() ? 0 : cell.x0 + 1;
  cell.y1 = cell.y0 + 1;
  cell.fx = std::clamp(x - static_cast<float>(cell.x0), 0.f, 1.f);
  cell.fy = std::clamp(y - static_cast<float>(cell.y0), 0.f, 1.f);
  return cell;
}

Vec2f SphericalImage::toSquare(Vec3f unit) const {
  const float u = std::atan2(unit.x, -unit.z) / kTwoPi - 0.5f / static_cast<float>(width());
  return {u - std::floor(u), std::acos(std::clamp(unit.y, -1.f, 1.f)) * kInvPi};
}

Vec3f SphericalImage::fromSquare(Vec2f s) const {
  const float phi = (s.x + 0.5f / static_cast<float>(width())) * kTwoPi;
  const float theta = s.y * kPi, sine = std::sin(theta);
  return {std::sin(phi) * sine, std::cos(theta), -std::cos(phi) * sine};
}

}  // namespace lobelia
