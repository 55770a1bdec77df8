#include "lobelia/gather/near_field.h"

#include <algorithm>
#include <cmath>

#include "lobelia/gather/light_block.h"

namespace lobelia::gather {
namespace {

bool meet(const Bounds3f& a, const Bounds3f& b) {
  for (int i = 0; i < 3; ++i)
    if (a.lo[i] > b.hi[i] || b.lo[i] > a.hi[i]) return false;
  return true;
}

// A little more than the near field: rounding must not lose a pair.
Bounds3f nearBounds(const SphericalLight& light, const SphereShading& shading) {
  const float reach = 1.00001f * std::sqrt(reachOf(shading, light.radius).to);
  const float slack =
      4e-7f * std::max({std::abs(light.p.x), std::abs(light.p.y), std::abs(light.p.z)});
  Bounds3f bounds;
  bounds.add(light.p - Vec3f(reach + slack));
  bounds.add(light.p + Vec3f(reach + slack));
  return bounds;
}

}  // namespace

SquaredRange reachOf(const SphereShading& shading, float radius) {
  const float limit = sqr(shading.nearField * radius);
  switch (shading.reach) {
    case SphereShading::Reach::nearField:
      return {0, limit};
    case SphereShading::Reach::farField:
      return {.from = limit};
    case SphereShading::Reach::all:
      break;
  }
  return {};
}

NearField::NearField(const VirtualLights& lights, size_t first)
    : lights_(lights),
      first_(first),
      used_(lights.sphereShading.reach == SphereShading::Reach::nearField) {
  if (!used_) return;
  for (size_t i = first; i < lights.spherical.size(); ++i) {
    if ((i - first) % kBlockLights == 0) blocks_.emplace_back();
    blocks_.back().add(nearBounds(lights.spherical[i], lights.sphereShading));
  }
}

std::vector<Bounds3f> NearField::boundsOf(const Tile& tile) {
  std::vector<Bounds3f> bounds(1 + tile.strips.size());
  for (size_t s = 0; s < tile.strips.size(); ++s) {
    for (int lane = 0; lane < kStrip; ++lane) bounds[1 + s].add(tile.strips[s].p.get(lane));
    bounds[0].add(bounds[1 + s]);
  }
  return bounds;
}

uint32_t NearField::reaching(const std::vector<Bounds3f>& bounds, size_t first,
                             size_t count) const {
  const Bounds3f& block = blocks_[(first - first_) / kBlockLights];
  if (!meet(bounds[0], block)) return 0;
  uint32_t lights = 0;
  for (size_t s = 1; s < bounds.size(); ++s) {
    if (!meet(bounds[s], block)) continue;
    for (size_t i = 0; i < count; ++i)
      if (meet(bounds[s], nearBounds(lights_.spherical[first + i], lights_.sphereShading)))
        lights |= 1u << i;
  }
  return lights;
}

}  // namespace lobelia::gather
