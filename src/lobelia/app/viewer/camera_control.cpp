#include "lobelia/app/viewer/camera_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobelia::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNearestToUp = 0.5 * kDegree;

Vec3d column(const Mat4& m, size_t i) { return {m.m[0][i], m.m[1][i], m.m[2][i]}; }
Vec3d wide(Vec3f v) { return {v.x, v.y, v.z}; }
Vec3f narrow(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// The signed coordinate axis nearest to a direction.
Vec3d nearestAxis(Vec3d v) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(v[i]) > std::abs(v[axis])) axis = i;
  Vec3d out{};
  out[axis] = v[axis] < 0 ? -1 : 1;
  return out;
}

// Turned about `up` by `right` radians clockwise seen from above, and raised by `rise`.
Vec3d turned(Vec3d direction, Vec3d up, double right, double rise) {
  const double elevation = std::asin(std::clamp(dot(direction, up), -1.0, 1.0));
  const double most = std::numbers::pi / 2 - kNearestToUp;
  const double raised = std::clamp(elevation + rise, -most, most);
  Vec3d level = direction - up * dot(direction, up);
  if (!(length(level) > 1e-9)) level = cross(up, Vec3d(up.y, up.z, up.x));
  level = normalize(level);
  const Vec3d ahead = level * std::cos(right) + cross(level, up) * std::sin(right);
  return normalize(ahead * std::cos(raised) + up * std::sin(raised));
}

Mat4 placement(Vec3d position, Vec3d forward, Vec3d up) {
  return lookAt(position, position + forward, up)
      .value_or(lookAt(position, position + forward, Vec3d(up.y, up.z, up.x)).value_or(Mat4()));
}

}  // namespace

CameraControl::CameraControl(const Camera& camera, const Bounds3f& scene) : scene_(scene) {
  const double size = scene.empty() ? 1 : static_cast<double>(scene.radius());
  pace_ = size > 0 ? size / 2 : 0.5;
  take(camera);
}

void CameraControl::take(const Camera& camera) {
  camera_ = camera;
  camera_.path.clear();  // a person moves it now
  const Mat4& to = camera.toWorld.to;
  position_ = column(to, 3);
  forward_ = normalize(column(to, 2));
  up_ = nearestAxis(column(to, 1));
  // A camera that looks straight along its up axis keeps that picture's top.
  forward_ = turned(forward_, up_, 0, 0);
  own_ = inverse(placement(position_, forward_, up_)).value_or(Mat4()) * to;
  const double away = scene_.empty() ? 1 : dot(wide(scene_.centre()) - position_, forward_);
  pivot_ = position_ + forward_ * std::max(away, pace_ * 0.1);
  // Exact until it is moved.
  for (size_t i = 0; i < 3; ++i) own_.m[i][3] = 0;
}

double CameraControl::distance() const {
  return std::max(length(pivot_ - position_), pace_ * 1e-6);
}

void CameraControl::write() {
  camera_.toWorld = Transform(placement(position_, forward_, up_) * own_);
}

// A wider film: as high as before.
double CameraControl::widths(int width, int height) const {
  const double own = static_cast<double>(camera_.width) / camera_.height;
  return std::max(static_cast<double>(width) / height / own, 1.);
}

Camera CameraControl::fitted(int width, int height) const {
  Camera out = camera_;
  const double wider = widths(width, height);
  out.width = width;
  out.height = height;
  out.cropX0 = out.cropY0 = out.cropX1 = out.cropY1 = 0;
  if (wider <= 1) return out;
  if (camera_.type == CameraType::perspective) {
    out.fovX = static_cast<float>(
        2 * std::atan(std::tan(0.5 * static_cast<double>(camera_.fovX)) * wider));
  } else {
    out.toWorld = Transform(out.toWorld.to * scaling({wider, wider, 1}));
  }
  return out;
}

void CameraControl::orbit(double right, double up) {
  const double away = distance();
  forward_ = turned(forward_, up_, right, up);
  position_ = pivot_ - forward_ * away;
  write();
}

void CameraControl::look(double right, double up) {
  const double away = distance();
  forward_ = turned(forward_, up_, right, up);
  pivot_ = position_ + forward_ * away;
  write();
}

void CameraControl::pan(double right, double down) {
  const double half = camera_.type == CameraType::perspective
                          ? std::tan(0.5 * static_cast<double>(camera_.fovX)) * distance()
                          : length(column(camera_.toWorld.to, 0));
  const Mat4 frame = placement(position_, forward_, up_);
  // x points to the left; what is in the picture follows the hand, so the camera goes against it.
  const Vec3d step = (column(frame, 0) * right + column(frame, 1) * down) * (2 * half);
  position_ += step;
  pivot_ += step;
  write();
}

void CameraControl::dolly(double factor) {
  const double kept = std::clamp(factor, 0.01, 100.0);
  if (camera_.type == CameraType::orthographic) {
    own_ = own_ * scaling({kept, kept, 1});
  } else {
    position_ = pivot_ - forward_ * std::clamp(distance() * kept, pace_ * 1e-4, pace_ * 1e4);
  }
  write();
}

void CameraControl::fly(Vec3d step) {
  const Mat4 frame = placement(position_, forward_, up_);
  const Vec3d move = column(frame, 0) * -step.x + up_ * step.y + forward_ * step.z;
  position_ += move;
  pivot_ += move;
  write();
}

void CameraControl::setFieldOfView(double radians) {
  camera_.fovX = static_cast<float>(std::clamp(radians, kDegree, 170 * kDegree));
}

void CameraControl::setPivot(Vec3f point) {
  const double away = dot(wide(point) - position_, forward_);
  if (away > pace_ * 1e-4) pivot_ = position_ + forward_ * away;
}

void CameraControl::approach(Vec3f point) {
  pivot_ = wide(point);
  const double away = std::max(length(pivot_ - position_) / 2, pace_ * 1e-3);
  position_ = pivot_ - forward_ * away;
  if (camera_.type == CameraType::orthographic) own_ = own_ * scaling({0.5, 0.5, 1});
  write();
}

void CameraControl::frame(const Bounds3f& box) {
  if (box.empty()) return;
  const double radius = std::max(static_cast<double>(box.radius()), pace_ * 1e-4);
  pivot_ = wide(box.centre());
  const double narrower = std::min(1.0, static_cast<double>(camera_.height) / camera_.width);
  if (camera_.type == CameraType::perspective) {
    const double half = std::atan(std::tan(0.5 * static_cast<double>(camera_.fovX)) * narrower);
    position_ = pivot_ - forward_ * (radius / std::sin(half));
  } else {
    const double wanted = radius / narrower / length(column(camera_.toWorld.to, 0));
    own_ = own_ * scaling({wanted, wanted, 1});
    position_ = pivot_ - forward_ * std::max(distance(), 2 * radius);
  }
  write();
}

std::string cameraLine(const Camera& camera) {
  const Mat4& to = camera.toWorld.to;
  const Vec3f o = narrow(column(to, 3)), t = narrow(column(to, 3) + normalize(column(to, 2))),
              u = narrow(normalize(column(to, 1)));
  return fmt::format("camera {},{},{} {},{},{} {},{},{}", o.x, o.y, o.z, t.x, t.y, t.z, u.x, u.y,
                     u.z);
}

}  // namespace lobelia::app
