// Solids and surfaces of the built-in scenes (internal to this room). y is up.
#pragma once

#include <functional>
#include <vector>

#include "lobelia/builtin/polygon.h"
#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

// The polygon (x, z) -> (x, -y of the polygon) raised from y = 0 to `height`, its upper and lower
// edges rounded with radius `bevel` in `bevelSegments` parts (0: sharp). uv: metres, as
// projectUvs().
Mesh extrude(const Polygon& polygon, float height, float bevel = 0, int bevelSegments = 0);

// Skin over polygons of the same number of corners at the given heights, each as in extrude(), from
// the first (its inside facing down when `startCap`) to the last (up when `endCap`).
struct Ring {
  Polygon outline;
  float height;
};
Mesh loft(const std::vector<Ring>& rings, bool startCap, bool endCap, float creaseDegrees = 50);

// Surface of revolution around y of a polyline of (distance from the axis, height), the outside at
// its right (for a wall: upwards); edges sharper than creaseDegrees stay sharp.
// uv = (angle / 2 pi, share of the polyline's length).
Mesh lathe(const std::vector<Vec2f>& profile, int segments, float creaseDegrees = 35);
// Of radius and height, standing on y = 0, its edges rounded.
Mesh cylinder(float radius, float height, float bevel, int bevelSegments, int segments);
// The same, its top in triangles that are about as wide as long: rings of 6, 12, 18... of them,
// closer in the middle (radii to the power 1.3), for methods that keep something at vertices.
Mesh roundSlab(float radius, float height, float bevel, int bevelSegments, int rings);
Mesh ball(float radius, int rows, int segments);
// Flat, facing up at y = 0; inner > 0: with a hole.
Mesh disc(float radius, int segments, float inner = 0);
// |x|^(2/east) + |z|^(2/east))^(east/north) + |y|^(2/north) = 1, scaled [A. H. Barr, "Superquadrics
// and Angle-Preserving Transformations", 1981]; 1, 1: an ellipsoid; towards 0: a box.
Mesh superellipsoid(Vec3f halfExtent, float north, float east, int rows, int segments);
// Each edge of an icosahedron in 2^subdivisions parts, moved to radius(direction). uv: longitude
// and latitude (their seam is not split).
Mesh icosphere(int subdivisions, const std::function<float(Vec3f)>& radius);
// Over [-sizeX / 2, sizeX / 2] x [-sizeZ / 2, sizeZ / 2], uv = (x, z) from 0 to 1; faces up.
Mesh heightfield(float sizeX, float sizeZ, int columns, int rows,
                 const std::function<float(Vec2f)>& heightAtUv);

}  // namespace lobelia::builtin
