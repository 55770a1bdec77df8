// The rays of every vertex: the directions of a grid, in registers, and how they lie to the grid of
// directions to the eye.
#pragma once

#include "lobelia/transfer/geodesic_grid.h"
#include "lobelia/transfer/lobe_weights.h"

namespace lobelia::transfer {

struct RaySphere {
  // rays: level of their grid.
  RaySphere(int rays, const GeodesicGrid& directions);

  GeodesicGrid grid;
  DirectionChunks chunks;             // of its directions
  relight::AlignedFloats solidAngle;  // by lane of the chunks; 0 after the last direction
  std::vector<GridPlace> back;  // by ray: the opposite of its direction among directions to the eye
};

}  // namespace lobelia::transfer
