#include "lobelia/transfer/ray_cells.h"

#include <algorithm>

namespace lobelia::transfer {

RayCells::RayCells(const RaySphere& fine, const GeodesicGrid& directions)
    : coarse(fine.grid.level() - 1, directions),
      rayOf(fine.grid.indicesOf(coarse.grid)),
      solidAngle(fine.solidAngle.size(), 0.f) {
  const GeodesicGrid& grid = fine.grid;
  std::vector<uint32_t> coarseOf(grid.count(), 0);
  for (uint32_t i = 0; i < rayOf.size(); ++i) {
    coarseOf[rayOf[i]] = i;
    solidAngle[rayOf[i]] = grid.solidAngles()[rayOf[i]];
  }
  const auto parents = grid.triangles(grid.level() - 1), children = grid.triangles(grid.level());
  for (size_t t = 0; t < parents.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = parents[t][k], b = parents[t][(k + 1) % 3];
      // Of two triangles that share an edge, one has it the other way round.
      if (a < b) middles.push_back({children[4 * t + 1][k], coarseOf[a], coarseOf[b]});
    }
  std::sort(middles.begin(), middles.end(),
            [](const Middle& x, const Middle& y) { return x.ray < y.ray; });
  for (const Middle& m : middles)
    for (const uint32_t end : {m.a, m.b})
      solidAngle[rayOf[end]] += 0.5f * grid.solidAngles()[m.ray];
}

}  // namespace lobelia::transfer
