// Profiles swept along curves (internal to this room): tubes, handles, rails, cords, mouldings.
#pragma once

#include <functional>
#include <vector>

#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

using Curve = std::function<Vec3f(float)>;  // t in [0,1]

// Smooth curve through points (uniform Catmull-Rom spline); closed: from the last on to the first.
Curve smoothCurve3(std::vector<Vec3f> points, bool closed = false);
// Straight lines through points, the corners rounded with `radius`; at equal speed.
Curve roundedPath(const std::vector<Vec3f>& points, float radius);

struct SweepOptions {
  bool closed = false;  // the curve ends where it starts
  bool capped = true;   // flat ends
  // The profile's x axis at the start is as near to this as the curve's direction allows.
  Vec3f sideHint{1, 0, 0};
  std::function<float(float)> scale;  // of the profile at t; empty: 1
  float creaseDegrees = 40;           // normals are smooth up to this angle
};

// The closed polygon `profile` (counter-clockwise, seen against the curve's direction) along a
// curve; the frame does not turn about the curve (parallel transport). uv = (around, along).
Mesh sweep(const std::vector<Vec2f>& profile, const Curve& curve, int along,
           const SweepOptions& options = {});
// A circular profile.
Mesh tube(const Curve& curve, float radius, int along, int around,
          const SweepOptions& options = {});

}  // namespace lobelia::builtin
