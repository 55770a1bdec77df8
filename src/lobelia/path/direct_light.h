// Direct lighting at a surface point: one emitter sample, combined with BSDF samples by the power
// heuristic (Veach 1997, section 9.2). `Rays` is Tracer, or what answers the same queries.
#pragma once

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/path/emitter_sampling.h"

namespace lobelia {

// Where light is asked for.
struct LightQuery {
  Vec3f p, ng;
  float error = 0;  // SurfacePoint::error
  Vec3f n;          // for EmitterSampler: the side that light counts from, zero for both
};

// The shading normal on the side of wo when the lobes only reflect; zero when they transmit.
inline Vec3f lightSide(const Bsdf& bsdf, Vec3f wo) {
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const LobeType type = bsdf.lobes[i].type;
    if (type == LobeType::microfacetTransmission || type == LobeType::diffuseTransmission)
      return {};
  }
  return dot(bsdf.frame.n, wo) < 0 ? -bsdf.frame.n : bsdf.frame.n;
}
inline LightQuery lightQuery(const SurfacePoint& at, const Bsdf& bsdf, Vec3f wo) {
  return {at.p, at.ng, at.error, lightSide(bsdf, wo)};
}

// Is the emitter sample's way from q free?
template <class Rays>
bool unoccluded(const Rays& tracer, const LightQuery& q, const EmitterDirection& light) {
  const Vec3f origin = offsetOrigin(q.p, q.ng, q.error, light.wi);
  if (light.distance < 1e38f) return tracer.visible(origin, light.target);
  Ray ray;
  ray.o = origin;
  ray.d = light.wi;
  return !tracer.occluded(ray);
}

// One sample of the light that an emitter sends to q, times f |cos| of the lobes in `lobes`.
// `sampled`: the lobes among which the accompanying BSDF samples are drawn (MIS); pass withBsdf =
// false when no BSDF sample accompanies. u: three uniform numbers. Counts the shadow ray.
template <class Rays>
Rgb sampleDirectLight(const Rays& tracer, const EmitterSampler& emitters, const LightQuery& q,
                      const Bsdf& bsdf, Vec3f wo, LobeSet lobes, LobeSet sampled, bool withBsdf,
                      Vec3f u, uint64_t* shadowRays) {
  const auto light = emitters.sampleDirection(q.p, q.n, u);
  if (!light) return {};
  Rgb value = evaluate(bsdf, wo, light->wi, lobes) * light->weight;
  if (value == Rgb{}) return {};
  if (!light->delta && withBsdf) {
    value *= powerHeuristic(light->pdf, pdf(bsdf, wo, light->wi, sampled));
  }
  ++*shadowRays;
  return unoccluded(tracer, q, *light) ? value : Rgb{};
}

// MIS weight of emission met by a BSDF sample of density bsdfPdf drawn at q. delta: the sample came
// from a delta lobe, which no emitter sample can replace. hit: null when the ray escaped.
inline float emissionWeight(const EmitterSampler& emitters, const LightQuery& q,
                            const SurfacePoint* hit, Vec3f wi, float bsdfPdf, bool delta) {
  if (delta) return 1;
  const float lightPdf =
      hit ? emitters.pdfHit(q.p, q.n, *hit, wi) : emitters.pdfEscaped(q.p, q.n, wi);
  return powerHeuristic(bsdfPdf, lightPdf);
}

}  // namespace lobelia
