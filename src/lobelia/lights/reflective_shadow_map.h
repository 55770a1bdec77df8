// Reflective shadow maps [P001 supplement, section 3.3; Dachsbacher05] of every
// emitter, by ray casting.
//
// A map's texels are the cells of the unit square from which an emitter draws the rays that leave
// one place on it (of emitters far away: in one direction). So all texels of a map have about the
// same power, whatever the emitter; a point lamp has one map where a rasteriser has the six faces
// of a cube, an area or an environment has several maps ("views"), each of a place or direction
// drawn in proportion to power.
#pragma once

#include <vector>

#include "lobelia/lights/light_pass.h"
#include "lobelia/lights/light_point.h"

namespace lobelia {

struct ReflectiveShadowMap {
  uint32_t size = 0;               // texels along a side, a power of two
  std::vector<LightPoint> texels;  // [y * size + x]; without power where no rough surface was met
  bool inOrderOfPlace = false;     // mapOfPoints()
};

struct ShadowMapSettings {
  size_t texels = 1u << 18;  // of all maps, about
  // 0: one where the scene's only emitter is a point or a direction, else four for each emitter, at
  // least 64.
  size_t views = 0;
};
struct ShadowMaps {
  std::vector<ReflectiveShadowMap> maps;  // light at depth 1
  // What the maps have no texels for: light that leaves the other side of what was met, and light
  // of greater depths: particles go on from the texels. With directAsLights also light on area
  // emitters (depth 0), a point of each view. Sorted as makeLightPoints() does.
  std::vector<LightPoint> others;
};
// The mean over seeds of all points is the light of the scene at depths >= 1, as far as settings
// say (whose count and kind do not matter). Books and counts as makeLights() does, and
// "rsm_texels": those with power.
ShadowMaps makeShadowMaps(const Tracer& tracer, const EmitterSampler& emitters,
                          const LightSettings& settings, const ShadowMapSettings& maps,
                          Context& context);

// Any points as a map: texels along a Morton curve of the square have the points along one of
// space, so that squares of texels hold neighbours. bounds: of the scene. The map is the smallest
// that is large enough; texels left over are the last along the curve.
ReflectiveShadowMap mapOfPoints(std::vector<LightPoint> points, const Bounds3f& bounds);

}  // namespace lobelia
