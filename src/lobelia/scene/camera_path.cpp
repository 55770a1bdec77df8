// Interpolation of cameras.
//
// A place is split into translation, rotation and the rest (scale, shear, mirror): the matrix' axes
// are made orthonormal by Gram and Schmidt, the direction of view first, then up; a mirrored frame
// has its first axis reversed, so that the rotation is one. Translations and the rest are blended
// linearly, rotations by slerp [Shoemake85].
//
// Through several views goes a Catmull-Rom curve in the pyramid of [BarryGoldman88], in which the
// linear blends of rotations are slerps [Schlag91]. Knots are centripetal [Yuksel11]:
// an interval is the square root of the distance, so that the curve has no cusp or loop between
// views. Deviation: as a distance counts the turn too (half a turn as much as the mean distance of
// neighbours), or a view that only turns would pass in no time; equal neighbours are a rest of mean
// length. At both ends the path goes on as a mirror image of its first and last interval.
#include "lobelia/scene/camera_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lobelia/base/quaternion.h"

namespace lobelia {
namespace {

constexpr double kPiD = 3.14159265358979323846;

// Everything that moves.
struct Pose {
  Vec3d position;
  Quaternion orientation;
  Mat4 rest;  // of the matrix, after rotation and translation; upper-left 3x3
  double fovX = 0, aperture = 0, focus = 0, nearClip = 0, farClip = 0, offsetX = 0, offsetY = 0;
};

Vec3d column(const Mat4& m, size_t c) { return {m.m[0][c], m.m[1][c], m.m[2][c]}; }

void setColumn(Mat4& m, size_t c, Vec3d v) { m.m[0][c] = v.x, m.m[1][c] = v.y, m.m[2][c] = v.z; }

void setPlace(Pose& pose, const Mat4& toWorld) {
  const Vec3d z = normalize(column(toWorld, 2));
  const Vec3d upward = column(toWorld, 1);
  const Vec3d y = normalize(upward - z * dot(z, upward));
  Mat4 frame;
  setColumn(frame, 0, cross(y, z)), setColumn(frame, 1, y), setColumn(frame, 2, z);
  pose.position = column(toWorld, 3);
  pose.orientation = quaternion(frame);
  Mat4 linear = toWorld;
  setColumn(linear, 3, {});
  pose.rest = transpose(frame) * linear;
}

Pose poseOf(const Camera& camera) {
  Pose pose;
  setPlace(pose, camera.toWorld.to);
  pose.fovX = static_cast<double>(camera.fovX);
  pose.aperture = static_cast<double>(camera.apertureRadius);
  pose.focus = static_cast<double>(camera.focusDistance);
  pose.nearClip = static_cast<double>(camera.nearClip);
  pose.farClip = static_cast<double>(camera.farClip);
  pose.offsetX = static_cast<double>(camera.principalPointOffset.x);
  pose.offsetY = static_cast<double>(camera.principalPointOffset.y);
  return pose;
}

constexpr double Pose::*kNumbers[] = {&Pose::fovX,     &Pose::aperture, &Pose::focus,
                                      &Pose::nearClip, &Pose::farClip,  &Pose::offsetX,
                                      &Pose::offsetY};

// a at t = 0, b at 1; goes on beyond both.
Pose mix(const Pose& a, const Pose& b, double t) {
  const auto linear = [t](double x, double y) { return x + (y - x) * t; };
  Pose out;
  out.position = a.position + (b.position - a.position) * t;
  out.orientation = slerp(a.orientation, b.orientation, t);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) out.rest.m[i][j] = linear(a.rest.m[i][j], b.rest.m[i][j]);
  for (const auto number : kNumbers) out.*number = linear(a.*number, b.*number);
  return out;
}

Transform place(const Pose& pose) {
  return Transform(translation(pose.position) * rotation(pose.orientation) * pose.rest);
}

// A curve may swing beyond its points, a field of view or a lens not: between its neighbours' it
// stays.
Pose limited(Pose pose, const Pose& a, const Pose& b) {
  for (const auto number : kNumbers) {
    pose.*number =
        std::clamp(pose.*number, std::min(a.*number, b.*number), std::max(a.*number, b.*number));
  }
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const double x = a.rest.m[i][j], y = b.rest.m[i][j];
      pose.rest.m[i][j] = std::clamp(pose.rest.m[i][j], std::min(x, y), std::max(x, y));
    }
  }
  return pose;
}

// [BarryGoldman88]: points p[0..3] at times t[0..3], for a time between t[1] and t[2].
Pose pyramid(const Pose (&p)[4], const double (&t)[4], double time) {
  const auto blend = [time](const Pose& a, const Pose& b, double ta, double tb) {
    return mix(a, b, (time - ta) / (tb - ta));
  };
  const Pose a0 = blend(p[0], p[1], t[0], t[1]), a1 = blend(p[1], p[2], t[1], t[2]),
             a2 = blend(p[2], p[3], t[2], t[3]);
  return blend(blend(a0, a1, t[0], t[2]), blend(a1, a2, t[1], t[3]), t[1], t[2]);
}

std::vector<double> knotsOf(const std::vector<Camera>& views) {
  std::vector<double> distances, angles;
  double sum = 0;
  for (size_t i = 0; i + 1 < views.size(); ++i) {
    const Pose a = poseOf(views[i]), b = poseOf(views[i + 1]);
    distances.push_back(length(b.position - a.position));
    angles.push_back(angleBetween(a.orientation, b.orientation));
    sum += distances.back();
  }
  const double mean = sum > 0 ? sum / static_cast<double>(distances.size()) : 1;
  std::vector<double> intervals;
  double total = 0;
  size_t moving = 0;
  for (size_t i = 0; i < distances.size(); ++i) {
    intervals.push_back(std::sqrt(distances[i] / mean + angles[i] / kPiD));
    // Rounding of equal orientations is no motion.
    if (intervals.back() < 1e-6) intervals.back() = 0;
    total += intervals.back();
    if (intervals.back() > 0) ++moving;
  }
  const double rest = moving > 0 ? total / static_cast<double>(moving) : 1;
  std::vector<double> knots{0};
  for (const double interval : intervals)
    knots.push_back(knots.back() + (interval > 0 ? interval : rest));
  return knots;
}

}  // namespace

Camera cameraAt(const Camera& camera, double time) {
  Camera out = camera;
  const std::vector<CameraKey>& keys = camera.path;
  const auto later = std::upper_bound(
      keys.begin(), keys.end(), time,
      [](double t, const CameraKey& key) { return t < static_cast<double>(key.time); });
  if (later == keys.begin()) {
    out.toWorld = keys.front().toWorld;
    return out;
  }
  const CameraKey& before = *(later - 1);
  if (later == keys.end() || static_cast<double>(before.time) == time) {
    out.toWorld = before.toWorld;
    return out;
  }
  Pose a, b;
  setPlace(a, before.toWorld.to), setPlace(b, later->toWorld.to);
  const double start = static_cast<double>(before.time), end = static_cast<double>(later->time);
  out.toWorld = place(mix(a, b, (time - start) / (end - start)));
  return out;
}

ViewPath::ViewPath(std::span<const Camera> views) : views_(views.begin(), views.end()) {
  if (views_.empty()) throw std::invalid_argument("a path needs a view");
  for (const Camera& view : views_) {
    if (view.type != views_.front().type)
      throw std::invalid_argument("perspective and orthographic cameras do not mix in a path");
    if ((view.toWorld.to.determinant3() < 0) != (views_.front().toWorld.to.determinant3() < 0))
      throw std::invalid_argument("some cameras of the path are mirror images of others");
  }
  knots_ = knotsOf(views_);
}

double ViewPath::parameter(size_t view) const {
  return knots_.size() > 1 ? knots_[view] / knots_.back() : 0;
}

Camera ViewPath::at(double u) const {
  const double time = std::clamp(u, 0., 1.) * knots_.back();
  Camera out = views_.front();
  out.path.clear();
  if (views_.size() == 1) return out;
  // The interval, and the nearest view when it is met exactly.
  const size_t last = views_.size() - 1;
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), time);
  const size_t i = std::min(static_cast<size_t>(after - knots_.begin()), last) - 1;
  Pose p[4];
  double t[4];
  p[1] = poseOf(views_[i]), t[1] = knots_[i];
  p[2] = poseOf(views_[i + 1]), t[2] = knots_[i + 1];
  if (i > 0) {
    p[0] = poseOf(views_[i - 1]), t[0] = knots_[i - 1];
  } else {
    p[0] = mix(p[1], p[2], -1), t[0] = 2 * t[1] - t[2];
  }
  if (i + 2 <= last) {
    p[3] = poseOf(views_[i + 2]), t[3] = knots_[i + 2];
  } else {
    p[3] = mix(p[1], p[2], 2), t[3] = 2 * t[2] - t[1];
  }
  const Pose pose = limited(pyramid(p, t, time), p[1], p[2]);
  out.toWorld = time == t[1]   ? views_[i].toWorld
                : time == t[2] ? views_[i + 1].toWorld
                               : place(pose);
  out.fovX = static_cast<float>(pose.fovX);
  out.apertureRadius = static_cast<float>(pose.aperture);
  out.focusDistance = static_cast<float>(pose.focus);
  out.nearClip = static_cast<float>(pose.nearClip);
  out.farClip = static_cast<float>(pose.farClip);
  out.principalPointOffset = {static_cast<float>(pose.offsetX), static_cast<float>(pose.offsetY)};
  return out;
}

Camera turned(const Camera& camera, Vec3d pivot, Vec3d axis, double turns) {
  Camera out = camera;
  out.path.clear();
  const double part = turns - std::floor(turns);
  if (part == 0) return out;
  out.toWorld = Transform(translation(pivot) * rotation(axis, 360 * part) * translation(-pivot) *
                          camera.toWorld.to);
  return out;
}

Vec3d turntablePivot(const Camera& camera, const Bounds3f& sceneBounds) {
  const Mat4& m = camera.toWorld.to;
  const Vec3d origin = column(m, 3), view = normalize(column(m, 2));
  if (sceneBounds.empty()) return origin + view;
  const Vec3f middle = sceneBounds.centre();
  const Vec3d centre{static_cast<double>(middle.x), static_cast<double>(middle.y),
                     static_cast<double>(middle.z)};
  const double along = dot(centre - origin, view);
  return along > 0 ? origin + view * along : centre;
}

Vec3d verticalAxis(const Camera& camera) {
  const Vec3d up = column(camera.toWorld.to, 1);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(up[i]) > std::abs(up[axis])) axis = i;
  Vec3d out{};
  out[axis] = up[axis] < 0 ? -1 : 1;
  return out;
}

}  // namespace lobelia
