// Which part of a spherical light's disc lies on the surface: 8 x 8 cells of the square around the
// disc in the tangent plane, one bit each. Cell (x, y) is bit 8 y + x; x and y run along s and t of
// discFrame() from -radius to radius.
#pragma once

#include <array>

#include "lobelia/base/frame.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/trace/tracer.h"

namespace lobelia {

inline constexpr int kDiscCells = 8;

// The tangent plane's frame for the geometric normal on the light's lit side.
inline Frame discFrame(Vec3f litNormal) { return frameFromNormal(litNormal); }

inline constexpr int kDiscCellCount = kDiscCells * kDiscCells;
inline bool coversCell(const SphericalLight& light, int bit) {
  return (light.coverage[bit / 32] >> (bit % 32) & 1) != 0;
}

// What the cells carry of the light's power per area, relative to an even spread over the whole
// disc. Where all lies on the surface: 1. Power of the cells that do not is mirrored at the
// boundary into those that do (the reflection method of density estimation [Schuster85], which is
// unbiased at a straight boundary of an evenly lit surface); the sum over the disc stays the same.
std::array<float, kDiscCellCount> cellWeights(const SphericalLight& light);

// Sets the coverage of every light, by one ray to the middle of each cell from a point above the
// light: what lies in or near the tangent plane there, and is turned alike, carries the light's
// power. Walls that cut through the disc and its parts beyond an edge do not. The radii must be
// set; where a part of the disc is missing they shrink by the root of its share, since neighbours
// are farther there only because there is less surface to find them on. With the cosine as
// indicator discs do not matter: all count as whole. Counts "path_rays".
void coverSurfaces(const Tracer& tracer, VirtualLights* lights, Context& context);

}  // namespace lobelia
