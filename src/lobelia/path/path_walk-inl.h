// The path tracer's loop, for any answerer of ray queries.
#pragma once

#include "lobelia/path/path_walk.h"

namespace lobelia {

inline Rgb absolute(Rgb c) { return {std::abs(c.x), std::abs(c.y), std::abs(c.z)}; }

template <class Rays>
PathResult PathWalk<Rays>::trace(Ray ray, PathRandom& random, PathCounts& counts) const {
  PathResult result;
  const int maxDepth = settings_.maxDepth < 0 ? 1 << 30 : settings_.maxDepth;
  if (maxDepth == 0) return result;
  Rgb chain(1.f), indirect{};         // throughput up to the current vertex
  Rgb metDirect(1.f), metIndirect{};  // factor of emission that the current ray meets
  LightQuery from;                    // where the ray started, and how it was drawn
  float pdfFrom = 0, eta = 1;
  int samplesFrom = 1;
  bool deltaFrom = true;

  const auto meet = [&](Rgb radiance, const SurfacePoint* hit, int depth) {
    if (radiance == Rgb{} || (depth == 1 && settings_.hideEmitters)) return;
    radiance *= emissionWeight(emitters_, from, hit, ray.d, pdfFrom, deltaFrom, samplesFrom);
    result.direct += metDirect * radiance;
    result.indirect += metIndirect * radiance;
  };

  for (int depth = 1;; ++depth) {
    ++counts.pathRays;
    const auto hit = tracer_.intersect(ray);
    if (!hit) {
      meet(emitters_.escaped(ray.d), nullptr, depth);
      break;
    }
    const SurfacePoint at = surfacePoint(emitters_.scene(), *hit);
    const Vec3f wo = -ray.d;
    if (at.emitter.valid()) meet(emitters_.emitted(at, wo), &at, depth);
    if (depth >= maxDepth && depth > 1) break;
    if (settings_.component == Component::direct && chain == Rgb{}) break;
    if (depth > settings_.rouletteDepth) {
      const float survival = rouletteSurvival(absolute(chain) + absolute(indirect), eta);
      if (!(random.next1D() < survival)) break;
      chain /= survival;
      indirect /= survival;
    }

    const Bsdf bsdf = makeBsdf(emitters_.scene(), at, wo, settings_.specularLimit);
    if (depth == 1) {
      result.albedo = albedo(bsdf, wo);
      result.normal = bsdf.frame.n;
      result.depth = hit->t;
      if (depth >= maxDepth) break;
    }
    from = lightQuery(at, bsdf, wo);
    samplesFrom = chain != Rgb{} ? std::max(settings_.directSamples, 1) : 1;

    const bool wanted = settings_.component != Component::indirect || indirect != Rgb{};
    if (wanted && !onlyDelta(bsdf)) {
      const float select = random.next1D();
      const Vec2f place = random.next2D();
      const Rgb light =
          sampleDirectLight(tracer_, emitters_, from, bsdf, wo, LobeSet::all, LobeSet::all, true,
                            {select, place.x, place.y}, &counts.shadowRays, samplesFrom);
      result.direct += chain * light;
      result.indirect += indirect * light;
    }

    const float uLobe = random.next1D();
    const auto s = sample(bsdf, wo, uLobe, random.next2D());
    if (!s || s->weight == Rgb{}) break;
    const Rgb sharp = sharpPart(bsdf, wo, *s, Transport::radiance);
    metDirect = chain * s->weight;
    metIndirect = indirect * s->weight;
    indirect = metIndirect + chain * (s->weight - sharp);
    chain = chain * sharp;
    eta *= s->eta;
    pdfFrom = s->pdf;
    deltaFrom = s->delta;
    ray = Ray{};
    ray.o = offsetOrigin(at, s->wi);
    ray.d = s->wi;
  }
  if (settings_.component == Component::direct) result.indirect = {};
  if (settings_.component == Component::indirect) result.direct = {};
  if (!isFinite(result.direct) || !isFinite(result.indirect)) {
    ++counts.nonFinite;
    result.direct = result.indirect = {};
  }
  return result;
}

}  // namespace lobelia
