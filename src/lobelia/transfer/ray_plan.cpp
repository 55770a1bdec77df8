#include "lobelia/transfer/ray_plan.h"

namespace lobelia::transfer {
namespace {

constexpr int kCoarsestRays = 5, kFinestRays = 6;

int rayLevelFor(float kappa) {
  int level = kCoarsestRays;
  while (level < kFinestRays && 10 * (1 << 2 * level) < static_cast<int>(38 * kappa)) ++level;
  return level;
}

std::vector<RaySphere> raySpheres(int level, const GeodesicGrid& directions) {
  std::vector<RaySphere> spheres;
  if (level > 0) {
    spheres.emplace_back(level, directions);
  } else {
    for (int l = kCoarsestRays; l <= kFinestRays; ++l) spheres.emplace_back(l, directions);
  }
  return spheres;
}

}  // namespace

RayPlan::RayPlan(int level, bool inCells, const GeodesicGrid& directions, const Scene& scene,
                 const ReflectionTables& tables, std::span<const TransferVertex> vertices)
    : spheres_(raySpheres(level, directions)) {
  if (inCells)
    for (const RaySphere& sphere : spheres_) cells_.emplace_back(sphere, directions);
  for (const TransferVertex& v : vertices) {
    const float kappa = tables.sharpest(scene.instances[v.instance].material);
    const int sphere = level > 0 ? 0 : rayLevelFor(kappa) - kCoarsestRays;
    sphereOf_.push_back(static_cast<uint8_t>(sphere));
    const RayCells* const cells = inCells ? &cells_[sphereOf_.back()] : nullptr;
    cellsOf_.push_back(cells && cellsSuffice(cells->rayOf.size(), kappa) ? cells : nullptr);
  }
}

}  // namespace lobelia::transfer
