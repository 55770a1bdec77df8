// A scene with what the light pass needs of it, and what that makes.
#pragma once

#include <utility>

#include "lobelia/lights/reflective_shadow_map.h"

namespace lobelia::test {

struct LightSource {
  explicit LightSource(Scene s, uint64_t seed = 0)
      : scene(std::move(s)), tracer(scene, context), emitters(scene, tracer.bounds()) {
    context.seed = seed;
  }
  VirtualLights run(const LightSettings& settings) {
    return makeLights(tracer, emitters, settings, context);
  }
  std::vector<LightPoint> points(const LightSettings& settings) {
    return makeLightPoints(tracer, emitters, settings, context);
  }
  ShadowMaps maps(const LightSettings& settings, const ShadowMapSettings& maps = {}) {
    return makeShadowMaps(tracer, emitters, settings, maps, context);
  }
  Context context;
  Scene scene;
  Tracer tracer;
  EmitterSampler emitters;
};

}  // namespace lobelia::test
