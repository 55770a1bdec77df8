// Which rays leave each vertex of a mesh, and in which cells bounces gather them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/transfer/ray_cells.h"
#include "lobelia/transfer/reflection.h"
#include "lobelia/transfer/transfer_mesh.h"
#include "lobelia/transfer/vertex_rays.h"

namespace lobelia::transfer {

// Grids of rays, as fine as a lobe needs: its solid angle, about 4 pi / kappa, has 38 rays or more,
// evenly spread, where the paper has 144 at random. Lobes sharper than kappa 1,078 have fewer.
class RayPlan {
 public:
  // level: of the grid of all vertices; 0: 5 or 6, by their materials. inCells: bounces may gather
  // rays of broad lobes in cells.
  RayPlan(int level, bool inCells, const GeodesicGrid& directions, const Scene& scene,
          const ReflectionTables& tables, std::span<const TransferVertex> vertices);
  RayPlan(const RayPlan&) = delete;
  RayPlan& operator=(const RayPlan&) = delete;

  // As GatherInput has them.
  std::span<const RaySphere> spheres() const { return spheres_; }
  std::span<const uint8_t> sphereOf() const { return sphereOf_; }
  std::span<const RayCells* const> cellsOf() const { return cellsOf_; }

 private:
  std::vector<RaySphere> spheres_;
  std::vector<RayCells> cells_;  // of spheres_
  std::vector<uint8_t> sphereOf_;
  std::vector<const RayCells*> cellsOf_;
};

}  // namespace lobelia::transfer
