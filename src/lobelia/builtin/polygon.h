// Simple polygons, counter-clockwise, of the built-in scenes (internal to this room).
#pragma once

#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::builtin {

using Polygon = std::vector<Vec2f>;

Polygon rectangle(float halfX, float halfY);
Polygon ellipse(float radiusX, float radiusY, int corners);
// Every corner becomes an arc of `segments` parts (radius as far as the edges allow).
Polygon rounded(const Polygon& polygon, float radius, int segments);
// All edges moved inwards; corners are mitred.
Polygon inset(const Polygon& polygon, float distance);
// Ear clipping [D. Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975].
std::vector<Vec3u> triangulate(const Polygon& polygon);

}  // namespace lobelia::builtin
