#include "lobelia/transfer/ray_sphere.h"

#include <algorithm>

#include "lobelia/base/parallel.h"

namespace lobelia::transfer {

RaySphere::RaySphere(int rays, const GeodesicGrid& directions)
    : grid(rays), chunks(grid.directions()), back(grid.count()) {
  solidAngle.assign(chunks.chunkCount() * relight::kChunk, 0);
  std::copy(grid.solidAngles().begin(), grid.solidAngles().end(), solidAngle.begin());
  parallelFor(grid.count(), 1024,
              [&](size_t i) { back[i] = directions.locate(-grid.directions()[i]); });
}

}  // namespace lobelia::transfer
