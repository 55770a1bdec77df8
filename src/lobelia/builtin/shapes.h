// Procedural meshes of the built-in scenes (internal to this room). y is up; normals are exact.
#pragma once

#include <functional>
#include <vector>

#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

// Box of the given half extents around the origin, its edges and corners rounded with `radius`,
// `segments` per 45 degrees. Each face covers [0,1]^2 of the uv plane.
Mesh roundedBox(Vec3f halfExtent, float radius, int segments);

// Surface of revolution around y: profile(t) is (distance from the axis, height) for t in [0,1],
// and runs so that the outside is at its right (for a wall: upwards). uv = (angle / 2 pi, t). Where
// the profile meets the axis the surface closes in a point.
Mesh revolve(const std::function<Vec2f(float)>& profile, int rows, int segments);

// Smooth curve through points, first to last (uniform Catmull-Rom spline).
std::function<Vec2f(float)> smoothCurve(std::vector<Vec2f> points);
// The same without loops where long spans meet short ones (centripetal tangents).
std::function<Vec2f(float)> centripetalCurve(std::vector<Vec2f> points);

// Tube of radius `tube` around the (p, q) torus knot that winds p times around y and q times around
// the ring of radius `ring`, at distance `wind` from it.
struct TorusKnot {
  int p = 2, q = 3;
  float ring = 0.2f, wind = 0.085f, tube = 0.05f;
};
Mesh torusKnot(const TorusKnot& knot, int along, int around);

}  // namespace lobelia::builtin
