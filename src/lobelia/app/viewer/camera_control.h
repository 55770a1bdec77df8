// How a person moves a camera: around a pivot, across and along the view, or flying.
//
// The camera stays upright: its up axis is the coordinate axis nearest to the one it came with, and
// it never looks closer to that axis than half a degree. What its transform has beyond place and
// direction (scale, mirroring) is kept.
#pragma once

#include "lobelia/scene/camera.h"

namespace lobelia::app {

class CameraControl {
 public:
  // scene: bounds of all there is; its centre says how far away the pivot is.
  CameraControl(const Camera& camera, const Bounds3f& scene);

  // Another camera, as from the scene's list or by "reset".
  void take(const Camera& camera);
  // As the scene's camera has its film and field of view.
  const Camera& camera() const { return camera_; }
  // The same view on a film of so many pixels: what the camera's own film shows stays in sight.
  Camera fitted(int width, int height) const;
  // How many widths of the camera's own film that view shows.
  double widths(int width, int height) const;

  // About the pivot; radians to the right and up.
  void orbit(double right, double up);
  // The camera's own direction.
  void look(double right, double up);
  // So far that what is at the pivot's distance moves by (right, down) widths of the film.
  void pan(double right, double down);
  // factor below 1: nearer to the pivot. An orthographic camera shows less.
  void dolly(double factor);
  // Scene units to the right, up and ahead.
  void fly(Vec3d step);
  void setFieldOfView(double radians);  // of the film's width, kept within 1 to 170 degrees
  // Turns about this point from now on, without moving.
  void setPivot(Vec3f point);
  // Looks at the point, from half as far.
  void approach(Vec3f point);
  // Looks at the box and fills the film with it, from the side that it is seen from.
  void frame(const Bounds3f& box);
  // Speed at which a person would like to fly: of scene units a second.
  double pace() const { return pace_; }

 private:
  void write();
  double distance() const;

  Camera camera_;
  Bounds3f scene_;
  double pace_ = 1;
  Vec3d position_{}, forward_{0, 0, 1}, up_{0, 1, 0}, pivot_{};
  Mat4 own_;  // what the transform has beyond place and direction
};

// `camera OX,OY,OZ TX,TY,TZ UX,UY,UZ`: the line of a script (view_script.h).
std::string cameraLine(const Camera& camera);

}  // namespace lobelia::app
