// Cameras that move: along the keys of a file, smoothly through several cameras, around the scene.
#pragma once

#include <span>

#include "lobelia/scene/camera.h"

namespace lobelia {

// The camera at a time of its path, which must not be empty: between two keys it moves straight and
// turns along the shorter arc, as Mitsuba 0.6 and glTF's linear samplers say; before the first and
// after the last it stands still. At a key's time its place is the key's to the bit.
Camera cameraAt(const Camera& camera, double time);

// A smooth path through cameras ("views"), from the first at 0 to the last at 1. Not before the
// first or beyond the last.
//
// What moves: place, orientation, field of view, lens, clip planes, principal point. Film, filter
// and name are the first view's. Two views are joined by a straight line.
class ViewPath {
 public:
  // Throws std::invalid_argument when there are no views, when perspective and orthographic ones
  // are mixed, or when some are mirror images (determinant of the other sign): no motion leads from
  // one to the other.
  explicit ViewPath(std::span<const Camera> views);
  Camera at(double u) const;
  // Where on the path a view is passed.
  double parameter(size_t view) const;

 private:
  std::vector<Camera> views_;
  std::vector<double> knots_;
};

// The camera after a part of a turn about an axis of the world, counterclockwise seen from the
// axis' tip. The axis goes through `pivot`.
Camera turned(const Camera& camera, Vec3d pivot, Vec3d axis, double turns);
// What a turn about the scene should keep in the picture's middle: the point of the line of sight
// nearest to the centre of the scene's bounds, or that centre itself when it is behind the camera
// or there is no scene.
Vec3d turntablePivot(const Camera& camera, const Bounds3f& sceneBounds);
// The world's axis (x, y or z, either way) that is nearest to up in the picture.
Vec3d verticalAxis(const Camera& camera);

}  // namespace lobelia
