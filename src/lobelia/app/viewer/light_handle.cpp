#include "lobelia/app/viewer/light_handle.h"

#include <algorithm>
#include <cmath>

namespace lobelia::app {
namespace {

// Pixels for one unit of camera space across the view, at depth z.
float pixelsPerUnit(const Camera& camera, float z) {
  const float width = static_cast<float>(camera.width);
  return camera.type == CameraType::perspective ? 0.5f * width / (std::tan(0.5f * camera.fovX) * z)
                                                : 0.5f * width;
}

}  // namespace

std::optional<Vec2f> project(const Camera& camera, Vec3f point) {
  const Vec3f local = camera.toWorld.from.point(point);
  if (camera.type == CameraType::perspective && !(local.z > 0)) return std::nullopt;
  const float scale = pixelsPerUnit(camera, local.z);
  const float width = static_cast<float>(camera.width), height = static_cast<float>(camera.height);
  const Vec2f film{(0.5f - camera.principalPointOffset.x) * width - local.x * scale,
                   (0.5f - camera.principalPointOffset.y) * height - local.y * scale};
  if (!std::isfinite(film.x) || !std::isfinite(film.y)) return std::nullopt;
  return film;
}

Vec3f movedAcross(const Camera& camera, Vec3f point, Vec2f pixels) {
  Vec3f local = camera.toWorld.from.point(point);
  if (camera.type == CameraType::perspective && !(local.z > 0)) return point;
  const float scale = pixelsPerUnit(camera, local.z);
  local.x -= pixels.x / scale;
  local.y -= pixels.y / scale;
  const Vec3f moved = camera.toWorld.point(local);
  return isFinite(moved) ? moved : point;
}

Vec3f movedAlong(const Camera& camera, Vec3f point, float share) {
  Vec3f local = camera.toWorld.from.point(point);
  const float factor = std::max(1 + share, 0.05f);
  if (camera.type == CameraType::perspective) {
    local *= factor;
  } else {
    local.z *= factor;
  }
  const Vec3f moved = camera.toWorld.point(local);
  return isFinite(moved) ? moved : point;
}

}  // namespace lobelia::app
