// The near field of spherical lights, which receivers gather from every light when others stand for
// all lights elsewhere.
//
// Past [Hasan09 section 3.3], whose representatives stand for all lights at all receivers. A light
// matters most to the little surface around it, which no row may have seen: scaled up, a
// representative then flares there, and where it is not drawn there is a dark spot. Distance splits
// the transport matrix in two: pairs nearer than a few radii of the light are gathered from all
// lights, the others from representatives of what their columns are without the near field. The
// split is exact, whatever the distance; the near part is sparse.
#pragma once

#include <vector>

#include "lobelia/gather/tile.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia::gather {

// Half-open range of squared distances of receivers to a light of this radius that count.
struct SquaredRange {
  float from = 0, to = 3.4e38f;
};
SquaredRange reachOf(const SphereShading& shading, float radius);

// Bounds of the near fields of all runs of kBlockLights spherical lights, to skip blocks none of
// whose lights is near a tile.
class NearField {
 public:
  // No block when the lights' reach is not the near field.
  explicit NearField(const VirtualLights& lights, size_t first);
  bool used() const { return used_; }

  // Bounds of a tile, then of its strips.
  static std::vector<Bounds3f> boundsOf(const Tile& tile);
  // Which of lights [first, first + count) are near a point of the tile, as far as bounds tell:
  // bit i for light first + i.
  uint32_t reaching(const std::vector<Bounds3f>& bounds, size_t first, size_t count) const;

 private:
  const VirtualLights& lights_;
  const size_t first_;
  bool used_;
  std::vector<Bounds3f> blocks_;
};

}  // namespace lobelia::gather
