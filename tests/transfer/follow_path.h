// Paths followed one by one by samples of the BSDF: brute force beside transfer.
#pragma once

#include "lobelia/base/random.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::test {

// From a place towards wo, over at most so many reflections. escaped(reflections before the last
// one, weight, direction) where the path leaves the scene.
template <class Escaped>
void followPath(const Tracer& tracer, SurfacePoint at, Vec3f wo, Rgb weight, size_t reflections,
                Rng& rng, const Escaped& escaped) {
  const Scene& scene = tracer.scene();
  for (size_t bounce = 0; bounce < reflections; ++bounce) {
    const Bsdf bsdf = makeBsdf(scene, at, wo, 0);
    const float lobe = rng.next1D();
    const auto drawn = sample(bsdf, wo, lobe, rng.next2D());
    if (!drawn) return;
    weight = weight * drawn->weight;
    const auto hit = tracer.intersect({offsetOrigin(at, drawn->wi), drawn->wi});
    if (!hit) {
      escaped(bounce, weight, drawn->wi);
      return;
    }
    at = surfacePoint(scene, *hit), wo = -drawn->wi;
  }
}

}  // namespace lobelia::test
