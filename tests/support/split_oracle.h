// The slow twin of the eye pass: plain path tracing without next-event estimation, which splits
// light by the definition itself. A path is direct when it reaches its emitter through sharp lobes
// alone or straight from its first rough lobe; else it is indirect.
#pragma once

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/path/emitter_sampling.h"

namespace lobelia::test {

struct SplitMeans {
  Rgb direct, indirect;
};

struct SplitOracle {
  const Tracer& tracer;
  const EmitterSampler& emitters;
  float specularLimit = 0.08f;
  int maxDepth = -1;
  // Paths whose first edge between two rough lobes is shorter are left out: sums over virtual
  // lights have no finite variance because of these, so that tests leave them out on both sides.
  float minDistance = 0;

  // Mean over all pixels of the camera.
  SplitMeans mean(const Camera& camera, int spp, uint64_t seed) const {
    std::vector<SplitMeans> rows(static_cast<size_t>(camera.height));
    parallelFor(rows.size(), 1, [&](size_t y) {
      Rng random(seed, y);
      for (int x = 0; x < camera.width; ++x)
        for (int s = 0; s < spp; ++s) {
          const Vec2f u = random.next2D();
          const Vec2f film(static_cast<float>(x) + u.x, static_cast<float>(y) + u.y);
          const Vec2f lens = random.next2D();
          follow(generateRay(camera, film, lens), random, &rows[y]);
        }
    });
    SplitMeans sum;
    for (const SplitMeans& r : rows) sum.direct += r.direct, sum.indirect += r.indirect;
    const float n = static_cast<float>(camera.width) * static_cast<float>(camera.height) *
                    static_cast<float>(spp);
    return {sum.direct / n, sum.indirect / n};
  }

 private:
  void follow(Ray ray, Rng& random, SplitMeans* sum) const {
    Rgb throughput(1.f);
    int sinceRough = -1;                         // edges since the first rough lobe; -1: none yet
    bool roughBefore = false, gathered = false;  // gathered: an edge between rough lobes was passed
    for (int edges = 1; maxDepth < 0 || edges <= maxDepth; ++edges) {
      const auto hit = tracer.intersect(ray);
      if (sinceRough >= 0) ++sinceRough;
      Rgb& part = sinceRough > 1 ? sum->indirect : sum->direct;
      if (!hit) {
        part += throughput * emitters.escaped(ray.d);
        return;
      }
      const SurfacePoint at = surfacePoint(tracer.scene(), *hit);
      if (at.emitter.valid()) part += throughput * emitters.emitted(at, -ray.d);
      const Bsdf bsdf = makeBsdf(tracer.scene(), at, -ray.d, specularLimit);
      // Rough and sharp lobes are sampled apart, so that it is known which ones a path took.
      const bool rough = hasLobes(bsdf, LobeSet::rough), sharp = hasLobes(bsdf, LobeSet::sharp);
      if (!rough && !sharp) return;
      const bool byRough = rough && (!sharp || random.next1D() < 0.5f);
      if (rough && sharp) throughput *= 2.f;
      const float uLobe = random.next1D();
      const auto s =
          sample(bsdf, -ray.d, uLobe, random.next2D(), byRough ? LobeSet::rough : LobeSet::sharp);
      if (!s) return;
      if (byRough && sinceRough < 0) sinceRough = 0;
      if (roughBefore && byRough && !gathered) {
        if (hit->t < minDistance) return;
        gathered = true;
      }
      roughBefore = byRough;
      throughput *= s->weight;
      if (edges > 3) {
        const float survival = std::min(0.95f, maxComponent(throughput));
        if (!(random.next1D() < survival)) return;
        throughput /= survival;
      }
      ray = {offsetOrigin(at, s->wi), s->wi};
    }
  }
};

}  // namespace lobelia::test
