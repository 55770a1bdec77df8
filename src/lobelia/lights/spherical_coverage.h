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

// Area of the cell inside the disc over the disc's area, by bit.
const std::array<float, kDiscCells * kDiscCells>& cellShares();
// Share of the disc's area that lies on the surface, in (0, 1].
float coveredShare(const SphericalLight& light);
inline bool coversCell(const SphericalLight& light, int bit) {
  return (light.coverage[bit / 32] >> (bit % 32) & 1) != 0;
}

// Sets the coverage of every light, by one ray to the middle of each cell from a point above the
// light: what lies in or near the tangent plane there, and is turned alike, carries the light's
// power. Walls that cut through the disc and its parts beyond an edge do not. The radii must be set.
// Counts "path_rays".
void coverSurfaces(const Tracer& tracer, VirtualLights* lights, Context& context);

}  // namespace lobelia
