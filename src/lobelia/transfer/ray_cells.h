// The rays of a vertex gathered into cells of the next coarser grid, for bounces.
//
// What is seen of infinity needs all rays, because masks have sharp edges. What arrives over other
// surfaces is smooth but where one ends before another, so that lobes that are broad beside the
// coarser grid's spacing need it no finer: a direction between two others counts half for each, and
// where all three meet one instance in places about in a row, what arrives along it is taken for the
// mean of both. That is a quarter of the sums, and fewer lookups. [P002 section 5.2 has 144 rays for each
// slice, whatever the lobe.]
#pragma once

#include "lobelia/transfer/ray_sphere.h"

namespace lobelia::transfer {

struct RayCells {
  // fine: a level above 0. Keeps nothing of it. directions: to the eye, as RaySphere has them.
  RayCells(const RaySphere& fine, const GeodesicGrid& directions);

  struct Middle {
    uint32_t ray;   // of the fine grid, between
    uint32_t a, b;  // of the coarse one
  };
  RaySphere coarse;
  std::vector<uint32_t> rayOf;  // by coarse direction: the same of the fine grid
  std::vector<Middle> middles;  // every other direction of the fine grid, ascending
  // By lane of the fine sphere's chunks: solid angle of the cell whose middle it is, else 0.
  relight::AlignedFloats solidAngle;
};

// Are cells of a sphere of rays with these many coarse directions enough for lobes up to kappa?
// Where a lobe's solid angle, about 4 pi / kappa, has 19 of them.
inline bool cellsSuffice(size_t coarseDirections, float kappa) {
  return static_cast<float>(coarseDirections) >= 19 * kappa;
}

}  // namespace lobelia::transfer
